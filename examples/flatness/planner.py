"""A flatness planner: a quadrotor carries its load on a taut cable along a polynomial of degree 15, from rest to rest.

The path of the load is a flat output: cable, attitude and thrusts follow from its derivatives up to the sixth (docs/models.md
has the equations). They are computed with Taylor series in time at every row: arrays K x n, row k the k-th coefficient.
Options: `duration_s`, and `bulge_m`, the distance by which the path leaves the straight line, to the left. Reads a request and
writes a reply (docs/external-planners.md).
"""

import json
import sys

import numpy as np
from numpy.polynomial import Polynomial

K = 7
prime = lambda a: np.vstack([a[1:] * np.arange(1, K)[:, None], 0 * a[:1]])
times = lambda a, b: np.array([sum(a[i] * b[k - i] for i in range(k + 1)) for k in range(K)])


def over(a, b):
    q = np.zeros_like(a)
    for k in range(K):
        q[k] = (a[k] - sum(b[i] * q[k - i] for i in range(1, k + 1))) / b[0]
    return q


def root(a):
    s = np.sqrt(a[:1]) * np.eye(K)[:, :1]
    for k in range(1, K):
        s[k] = (a[k] - sum(s[i] * s[k - i] for i in range(1, k))) / (2 * s[0])
    return s


def angle(a, b):
    """atan2(a, b), whose derivative is (a' b - a b')/(a² + b²)."""
    rate = over(times(prime(a), b) - times(a, prime(b)), times(a, a) + times(b, b))
    return np.vstack([np.arctan2(a[:1], b[:1]), rate[:-1] / np.arange(1, K)[:, None]])


def plan(vehicle, gravity, duration_s=5.0, bulge_m=0.0):
    model, T = vehicle["model"], duration_s
    begin, end = (np.array(vehicle[at]["load_position_m"]) for at in ("start", "goal"))
    left = np.cross([0, 0, 1], end - begin) / np.linalg.norm((end - begin)[:2])
    bump = Polynomial([0, 1]) ** 7 * Polynomial([1, -1]) ** 7  # seven derivatives of zero at both ends
    step = bump.integ() / bump.integ()(1)
    t = np.linspace(0, T, int(T / 0.01) + 1)
    taylor = lambda p: np.array([p.deriv(k)(t / T) / T**k / np.prod(range(1, k + 1)) if k else p(t / T) for k in range(K)])
    load = [b + taylor(step) * (e - b) + taylor(bump) * 4**7 * bulge_m * a for b, e, a in zip(begin, end, left)]
    for axis in range(3):
        load[axis][1:] -= begin[axis]  # the constant has no derivatives
    up = [0, 0, gravity * np.eye(K)[:, :1]]
    pull = [prime(prime(p)) + g for p, g in zip(load, up)]  # the force of the cable per kg of the load
    tension = root(sum(times(p, p) for p in pull))
    body = [p + model["cable_length_m"] * over(f, tension) for p, f in zip(load, pull)]
    force = [model["mass_kg"] * (prime(prime(p)) + g) + model["load_mass_kg"] * f for p, g, f in zip(body, up, pull)]
    total = root(sum(times(f, f) for f in force))
    x, y, z = (over(f, total) for f in force)  # the body's z axis
    cos_roll = root(times(x, x) + times(z, z))
    roll, pitch = angle(-y, cos_roll), angle(x, z)
    rates = [prime(roll), times(prime(pitch), cos_roll), times(prime(pitch), y)]  # the yaw is 0
    I, w, alpha = np.array(model["inertia_kgm2"]), np.array([r[0] for r in rates]), np.array([r[1] for r in rates])
    torque = I[:, None] * alpha + np.cross(w.T, (I[:, None] * w).T).T
    levers = np.array([model["arm_m"], model["arm_m"], model["torque_per_thrust_m"]])
    thrusts = (total[0] + np.array([[-1, -1, 1], [1, -1, -1], [1, 1, 1], [-1, 1, -1]]) / levers @ torque) / 4
    columns = dict(zip("x_m y_m z_m load_x_m load_y_m load_z_m".split(), (p[0] for p in body + load)))
    columns |= dict(zip("vx_mps vy_mps vz_mps load_vx_mps load_vy_mps load_vz_mps".split(), (p[1] for p in body + load)))
    columns |= {"roll_rad": roll[0], "pitch_rad": pitch[0], "yaw_rad": 0 * t, "t_s": t}
    columns |= dict(zip("rate_x_radps rate_y_radps rate_z_radps".split(), w))
    columns |= {f"thrust_{rotor + 1}_n": thrusts[rotor] for rotor in range(4)}
    return {"vehicle": vehicle["name"], "cable": ["taut"] * len(t), **{name: rows.tolist() for name, rows in columns.items()}}


request = json.load(sys.stdin)
trajectories = [plan(vehicle, request["gravity_mps2"], **request["options"]) for vehicle in request["vehicles"]]
json.dump({"protocol": 2, "status": "solved", "trajectories": trajectories}, sys.stdout)
