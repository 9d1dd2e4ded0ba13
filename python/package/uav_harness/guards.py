"""The judge as a guard: may this candidate trajectory be published to the vehicle?"""

from __future__ import annotations

from dataclasses import dataclass

from uav_harness import native
from uav_harness.geometry import Motion
from uav_harness.scenarios import Scenario


@dataclass(frozen=True)
class Margin:
    """One check of a candidate."""

    check: str
    """`start.position`, `start.velocity`, or the judge's name: `plan.clearance`, `plan.state_limits`, ..."""
    status: str
    """`pass`, `fail`, `undecided`, or `skip` where there is nothing to compare with."""
    value: float
    """What was found, in `unit`; of a clearance the lower bound. NaN if nothing was."""
    limit: float
    """What it is held against, in `unit`."""
    margin: float
    """Distance to the limit, positive when it is kept, in `unit`."""
    unit: str
    at_s: float
    """When, s."""
    of: str | None
    """The obstacle, or the limited quantity."""


@dataclass(frozen=True)
class Assessment:
    """What the guard says of a candidate."""

    status: str
    """`fail` if a check failed, else `undecided` if one is, else `pass`."""
    margins: list[Margin]
    reason: str | None = None
    """Why the candidate is no motion at all; every check has then failed."""

    @property
    def passed(self) -> bool:
        """Whether every check that was made passed. Undecided is not a pass."""
        return self.status == "pass"

    def check(self, name: str) -> Margin:
        """The check of this name. Raises KeyError."""
        for margin in self.margins:
            if margin.check == name:
                return margin
        raise KeyError(name)

    def __repr__(self) -> str:
        worst = [f"{m.check} {m.margin:+.3f} {m.unit}" for m in self.margins if m.status in ("fail", "undecided")]
        return f"<Assessment {self.status}{': ' + self.reason if self.reason else ''} {'; '.join(worst)}>"


class Guard:
    """Judges candidates for one multirotor, again and again, with the judge's own checks and without a simulation.

    >>> scenario = Scenario.load("shipped:trap")
    >>> guard = Guard(scenario)
    >>> start = [scenario["vehicles"][0]["start"][axis] for axis in ("x_m", "y_m", "z_m")]
    >>> hover = Motion([0.0, 5.0], [start, start], [[0.0, 0.0, 0.0]] * 2)
    >>> guard.judge(hover, measured=(0.0, start, [0.0, 0.0, 0.0])).passed
    True
    >>> there = Motion([0.0, 5.0], [start, [start[0], start[1] + 1e3, start[2]]], [[0.0, 0.0, 0.0]] * 2)
    >>> guard.judge(there).check("plan.control_limits").of
    'acceleration'
    """

    def __init__(self, scenario: Scenario, vehicle: str | None = None) -> None:
        """A guard that knows all obstacles of the scenario. `vehicle`: default the only one.

        Raises InvalidInput if the scenario is not one of multirotors, or has no such vehicle.
        """
        if vehicle is None and len(scenario.vehicles) != 1:
            raise native.InvalidInput(f"vehicle: expected one of {', '.join(scenario.vehicles)}")
        self._native = native.Guard(scenario._native, vehicle or scenario.vehicles[0])

    def set_world(self, scenario: Scenario) -> None:
        """Replaces the map and the obstacles by those of a scenario: what is known now."""
        self._native.set_world(scenario._native)

    def judge(
        self,
        candidate: Motion,
        measured: tuple[float, list[float], list[float]] | None = None,
    ) -> Assessment:
        """Judges the cubics through the knots of `candidate`, after which the vehicle hovers.

        `measured`: time, s, position, m, and velocity, m/s, of the vehicle now, which the candidate has to continue.
        """
        status, reason, rows = self._native.judge(candidate.arrays(), measured)
        return Assessment(status, [Margin(*row) for row in rows], reason)
