"""What every planner needs: distances to the world, smooth curves, closest approach."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uav_harness import native
from uav_harness.scenarios import Scenario

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Distances:
    """Signed distances of n points to the nearest obstacle."""

    distance_m: Floats
    """Shape (n,), m; negative inside, infinite in a world without obstacles."""
    gradient: Floats
    """Shape (n, 3): derivative of the distance by the position, -. A unit vector except at edges of equal distance."""
    obstacle: list[str]
    """Names of the nearest obstacles."""


def signed_distance(scenario: Scenario, points_m: ArrayLike, t_s: float = 0.0) -> Distances:
    """Signed distances of points, shape (n, 3) or (3,), to the surface of the nearest obstacle of the scenario, hidden and
    moving ones included, the latter at the time `t_s`. The same code as the judge's.

    >>> scenario = Scenario.load("shipped:forest")
    >>> tree = scenario["world"]["cylinders"][0]
    >>> x, y = tree["center_m"]
    >>> at = signed_distance(scenario, [x + tree["radius_m"] + 0.1, y, 1.0])
    >>> at.obstacle, round(float(at.distance_m[0]), 6), [round(float(g), 6) for g in at.gradient[0]]
    (['tree-1'], 0.1, [1.0, 0.0, 0.0])
    """
    points = _floats(points_m).reshape(-1, 3)
    distances, gradients, names = native.distances(scenario._native, points, t_s)
    return Distances(_array(distances), _array(gradients).reshape(-1, 3), names)


@dataclass(frozen=True)
class Motion:
    """The cubics between knots (Hermite): how the judge and the simulator understand a multirotor's plan.

    >>> motion = Motion([0.0, 2.0], [[0, 0, 1], [2, 0, 1]], [[1, 0, 0], [1, 0, 0]])
    >>> [float(x) for x in motion.at([0.5, 1.0])[0][:, 0]]
    [0.5, 1.0]
    """

    t_s: ArrayLike
    """Times of the knots, shape (n,), s, not decreasing."""
    position_m: ArrayLike
    """Positions, shape (n, 3), m."""
    velocity_mps: ArrayLike
    """Velocities, shape (n, 3), m/s."""

    def at(self, t_s: ArrayLike) -> tuple[Floats, Floats]:
        """Positions, m, and velocities, m/s, of shape (k, 3) at k times, s; NaN before the first knot and after the last."""
        positions, velocities = native.hermite(self.arrays(), np.atleast_1d(_floats(t_s)))
        return _array(positions).reshape(-1, 3), _array(velocities).reshape(-1, 3)

    def arrays(self) -> tuple[Floats, Floats, Floats]:
        """Times, positions and velocities as arrays."""
        return _floats(self.t_s), _floats(self.position_m), _floats(self.velocity_mps)

    def columns(self) -> dict[str, Floats]:
        """The columns of a multirotor's plan, for `check`."""
        times, positions, velocities = self.arrays()
        names = ["x_m", "y_m", "z_m", "vx_mps", "vy_mps", "vz_mps"]
        return {"t_s": times, **dict(zip(names, np.hstack([positions, velocities]).T, strict=True))}


@dataclass(frozen=True)
class ClosestApproach:
    """Bounds of the smallest distance of two motions over continuous time."""

    lower_m: float
    upper_m: float
    at_s: float


def closest_approach(first: Motion, second: Motion, horizontal: bool = False) -> ClosestApproach | None:
    """The closest approach of two motions while both last; `None` if they never do at the same time.

    >>> east = Motion([0.0, 10.0], [[0, 0, 0], [10, 0, 0]], [[1, 0, 0]] * 2)
    >>> north = Motion([0.0, 10.0], [[5, -7, 0], [5, 3, 0]], [[0, 1, 0]] * 2)
    >>> found = closest_approach(east, north)
    >>> round(found.upper_m, 6), round(found.at_s, 3)
    (1.414214, 6.0)
    """
    found = native.closest_approach(first.arrays(), second.arrays(), horizontal)
    return None if found is None else ClosestApproach(*found)


@dataclass(frozen=True)
class BSpline:
    """A uniform cubic B-spline, as planners of the EGO family optimise it.

    p(t) = sum_i B3(t / dt - i) q_i on [0, (n - 3) dt] for the control points q_0 .. q_(n-1), n at least 4

    >>> spline = BSpline([[float(i), 0.0, 1.0] for i in range(6)], 0.5)
    >>> spline.duration_s, [round(float(x), 9) for x in spline.at([0.0, 1.5])[:, 0]]
    (1.5, [1.0, 4.0])
    """

    control_points_m: ArrayLike
    """Shape (n, 3), m."""
    interval_s: float
    """Time between two knots, s."""

    @property
    def duration_s(self) -> float:
        """Time at the end of the curve, s."""
        return (len(_floats(self.control_points_m)) - 3) * self.interval_s

    def at(self, t_s: ArrayLike, derivative: int = 0) -> Floats:
        """Value of a derivative (0: position, m; 1: m/s; 2: m/s²; 3: m/s³) at k times, s: shape (k, 3)."""
        points = _floats(self.control_points_m)
        if points.ndim != 2 or points.shape[0] < 4 or points.shape[1] != 3:
            raise native.InvalidInput(f"control points: found the shape {points.shape}, expected (n, 3) with n >= 4")
        along = np.atleast_1d(_floats(t_s)) / self.interval_s
        first = np.clip(np.floor(along), 0, len(points) - 4).astype(int)
        u = along - first
        powers = np.zeros((len(u), 4))
        for power in range(derivative, 4):
            factor = float(np.prod(np.arange(power, power - derivative, -1)))
            powers[:, power] = factor * u ** (power - derivative)
        weights = powers @ _CUBIC / self.interval_s**derivative
        curve: Floats = np.einsum("ki,kix->kx", weights, points[first[:, None] + np.arange(4)])
        return curve

    def motion(self) -> Motion:
        """The same curve as cubics between its knots, for `check` and `Guard`."""
        times = self.interval_s * np.arange(len(_floats(self.control_points_m)) - 2)
        return Motion(times, self.at(times), self.at(times, 1))


_CUBIC = np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6.0
"""Coefficients of 1, u, u² and u³ (rows) of the four basis functions on a knot interval."""


def _floats(values: ArrayLike) -> Floats:
    return np.ascontiguousarray(values, dtype=np.float64)


def _array(numbers: bytearray) -> Floats:
    return np.frombuffer(numbers, dtype=np.float64)
