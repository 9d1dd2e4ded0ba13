"""Minimum time by trapezoidal collocation with CasADi and IPOPT, as a textbook writes it.

An external planner (docs/external-planners.md): reads a request from standard input, writes a reply to standard output.
IPOPT reports an optimal solution, and every constraint holds at every node. Between the nodes nobody has looked.

    pip install casadi
    harness run --name rendezvous-1 --planner-command 'python3 examples/published-optimiser/planner.py' --html
"""

import json
import sys

import casadi as ca
import numpy as np

STATES = ["x_m", "y_m", "z_m", "speed_mps", "heading_rad", "flight_path_rad"]
CONTROLS = ["n_x", "n_y", "n_z"]


def derivative(state, control, gravity):
    """Point mass with load factors."""
    _, _, _, v, heading, climb = ca.vertsplit(state)
    n_x, n_y, n_z = ca.vertsplit(control)
    return ca.vertcat(
        v * ca.cos(climb) * ca.cos(heading), v * ca.cos(climb) * ca.sin(heading), v * ca.sin(climb),
        gravity * (n_x - ca.sin(climb)), gravity * n_y / (v * ca.cos(climb)), gravity * (n_z - ca.cos(climb)) / v,
    )


def plan(request):
    """The trajectory of the only vehicle and IPOPT's status."""
    (vehicle,) = request["vehicles"]
    limits, intervals = vehicle["planning_limits"], request["options"].get("intervals", 20)
    start, goal = ([vehicle[end][name] for name in STATES] for end in ("start", "goal"))
    opti = ca.Opti()
    x, u, duration = opti.variable(6, intervals + 1), opti.variable(3, intervals + 1), opti.variable()
    step = duration / intervals
    rates = [derivative(x[:, k], u[:, k], request["gravity_mps2"]) for k in range(intervals + 1)]
    for k in range(intervals):
        opti.subject_to(x[:, k + 1] == x[:, k] + step / 2 * (rates[k] + rates[k + 1]))
    for cylinder in request["world"]["cylinders"]:
        keep_off = cylinder["radius_m"] + vehicle["body_radius_m"]
        for k in range(intervals + 1):
            offset = x[:2, k] - ca.DM(cylinder["center_m"])
            opti.subject_to(ca.sumsqr(offset) / keep_off**2 >= 1)
    for row, name in ((2, "altitude_m"), (3, "speed_mps"), (5, "flight_path_rad")):
        opti.subject_to(opti.bounded(limits[name][0], x[row, :], limits[name][1]))
    for row, name in enumerate(CONTROLS):
        opti.subject_to(opti.bounded(limits[name][0], u[row, :], limits[name][1]))
    opti.subject_to(x[:, 0] == start)
    opti.subject_to(x[:, intervals] == goal)
    opti.subject_to(duration >= 1)
    opti.minimize(duration + 1e-2 * ca.sumsqr(ca.diff(u, 1, 1)))
    distance = np.hypot(goal[0] - start[0], goal[1] - start[1])
    opti.set_initial(duration, distance / start[3])
    opti.set_initial(x, np.linspace(start, goal, intervals + 1).T)
    opti.set_initial(u, np.tile([[0], [0], [1]], intervals + 1))
    opti.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes", "max_iter": 1000})
    solution = opti.solve()
    times = np.linspace(0, solution.value(duration), intervals + 1)
    values = [*solution.value(x), *solution.value(u)]
    columns = {name: value.tolist() for name, value in zip(STATES + CONTROLS, values)}
    return {"vehicle": vehicle["name"], "t_s": times.tolist(), **columns}, opti.stats()["return_status"]


trajectory, status = plan(json.load(sys.stdin))
print(f"IPOPT: {status}", file=sys.stderr)
json.dump({"protocol": 2, "status": "solved", "trajectories": [trajectory]}, sys.stdout)
