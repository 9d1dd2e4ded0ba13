"""An external planner: one aircraft at constant speed and altitude, on a cubic spline round the obstacles.

Reads a request from standard input and writes a reply to standard output, both JSON (see docs/external-planners.md).
The spline passes through two points beside the straight line from start to goal. The fastest of all splines that keep
their distance from obstacles and their load factor within its limit is the plan.
"""

import itertools
import json
import sys

import numpy as np


def spline(knots, first, last, per_piece=100):
    """Points, n x 2, of the C2 cubic spline through `knots`, m, with the directions `first` and `last` at its ends."""
    h = np.linalg.norm(np.diff(knots, axis=0), axis=1)
    slope = np.diff(knots, axis=0) / h[:, None]
    a, b = np.eye(len(knots)), np.array([first, *np.zeros((len(knots) - 2, 2)), last])
    for k in range(1, len(knots) - 1):
        a[k, k - 1 : k + 2] = 1 / h[k - 1], 2 / h[k - 1] + 2 / h[k], 1 / h[k]
        b[k] = 3 * (slope[k - 1] / h[k - 1] + slope[k] / h[k])
    m = np.linalg.solve(a, b)
    s = np.linspace(0, 1, per_piece, endpoint=False)[:, None]
    pieces = [
        (2 * s**3 - 3 * s**2 + 1) * knots[k] + (s**3 - 2 * s**2 + s) * h[k] * m[k]
        + (3 * s**2 - 2 * s**3) * knots[k + 1] + (s**3 - s**2) * h[k] * m[k + 1]
        for k in range(len(h))
    ]
    return np.vstack([*pieces, knots[-1:]])


def fly(points, speed, gravity):
    """Times, headings and horizontal load factors along `points` at constant speed: s, rad, -."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    t = np.concatenate([[0], np.cumsum(steps)]) / speed
    heading = np.unwrap(np.arctan2(*np.gradient(points, t, axis=0, edge_order=2).T[::-1]))
    return t, heading, speed * np.gradient(heading, t, edge_order=2) / gravity


def plan(request):
    """The trajectory of the only vehicle, by the columns of the protocol, or None."""
    (vehicle,) = request["vehicles"]
    start, goal, limit = vehicle["start"], vehicle["goal"], vehicle["planning_limits"]
    margin = request["options"].get("margin_m", 60)
    ends = [np.array([at["x_m"], at["y_m"]]) for at in (start, goal)]
    directions = [np.array([np.cos(at["heading_rad"]), np.sin(at["heading_rad"])]) for at in (start, goal)]
    along = ends[1] - ends[0]
    across = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    best = None
    for offsets in itertools.product(np.arange(-1500, 1501, 150), repeat=2):
        inner = [ends[0] + along * share + across * offset for share, offset in zip((1 / 3, 2 / 3), offsets)]
        points = spline(np.array([ends[0], *inner, ends[1]]), *directions)
        gaps = [np.hypot(*(points - c["center_m"]).T).min() - c["radius_m"] for c in request["world"]["cylinders"]]
        t, heading, n_y = fly(points, start["speed_mps"], request["gravity_mps2"])
        ok = min(gaps, default=np.inf) > margin and np.abs(n_y).max() < 0.9 * limit["n_y"][1]
        if ok and (best is None or t[-1] < best[0][-1]):
            best = t, points, heading, n_y
    if best is None:
        return None
    t, points, heading, n_y = best
    times = np.linspace(0, t[-1], int(np.ceil(t[-1] / 0.5)) + 1)
    columns = {"t_s": times, "x_m": np.interp(times, t, points[:, 0]), "y_m": np.interp(times, t, points[:, 1])}
    columns |= {"heading_rad": np.interp(times, t, heading), "n_y": np.interp(times, t, n_y)}
    level = {"z_m": start["z_m"], "speed_mps": start["speed_mps"], "flight_path_rad": 0.0, "n_x": 0.0, "n_z": 1.0}
    columns |= {name: np.full_like(times, value) for name, value in level.items()}
    return {"vehicle": vehicle["name"], **{name: values.tolist() for name, values in columns.items()}}


request = json.load(sys.stdin)
trajectory = plan(request)
reply = {"protocol": 2, "status": "solved" if trajectory else "no-plan", "trajectories": [trajectory] if trajectory else []}
json.dump(reply, sys.stdout)
