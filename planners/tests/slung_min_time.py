"""Minimum times of a quadrotor with a slung load by direct multiple shooting (CasADi, IPOPT) from many starts.

    pip install casadi
    python planners/tests/slung_min_time.py [STARTS]

Independent of `slung-lgr`: body rates in place of Euler angle rates, Runge-Kutta steps, thrusts that are constant on each
of 60 intervals. The coarse thrusts make the flights a little longer; the constraints hold at the ends of the intervals.

The minimum over 4 starts beside the flight time of `slung-lgr`, s, whose cost has a weight on the effort of 3e-5 of the time; then
with three times and with a third of that weight (last column: on meshes of 40 segments of 4 points at first):

    case         shooting    slung-lgr    weight 1e-4    weight 1e-5
    block, left   2.9122       2.9094        2.9298         2.9079
    level         1.9276       1.9274        1.9405         1.9261
    diagonal      1.9165       1.9175        1.9280         1.9149
    climb         1.5052       1.5038        1.5050         1.5032
    short         1.4711       1.4718        1.4778         1.4710
"""

import sys

import casadi as ca
import numpy as np

G_MPS2 = 9.81
QUADROTOR_KG, LOAD_KG, CABLE_M, ARM_M, YAW_M = 1.32, 0.2, 0.65, 0.225, 1.0
INERTIA_KGM2 = (0.01768, 0.01764, 0.026432)
RADIUS_M, CLEARANCE_M = 0.225 + 0.127, 0.05
THRUST_N, EULER_RAD, CABLE_RAD = (1, 5), np.pi / 4, np.pi / 3
INTERVALS, STEPS_PER_INTERVAL = 60, 2

# start, goal, and whether the block of 3 m x 2 m, rotated by -45 deg, stands at the origin
CASES = {
    "block": ((-2, 0, 1.3), (2, 0, 1.5), True),
    "level": ((-2, 0, 1.3), (2, 0, 1.3), False),
    "diagonal": ((-1, -1, 1.0), (2, 1, 1.8), False),
    "climb": ((0, 0, 1.0), (0.5, 0, 3.0), False),
    "short": ((0, 0, 1.0), (1, 0, 1.0), False),
}


def dynamics():
    """State: position, yaw, pitch, roll, alpha, beta, velocity, body rates, rates of alpha and beta."""
    x, u = ca.SX.sym("x", 16), ca.SX.sym("u", 4)
    psi, theta, phi, a, b = [x[i] for i in range(3, 8)]
    velocity, p, q, r, da, db = x[8:11], *[x[i] for i in range(11, 16)]
    c, s = ca.cos, ca.sin
    specific = ca.sum1(u) / QUADROTOR_KG
    b3 = ca.vertcat(
        c(psi) * s(theta) * c(phi) + s(psi) * s(phi), s(psi) * s(theta) * c(phi) - c(psi) * s(phi), c(theta) * c(phi)
    )
    d = ca.vertcat(-c(a) * s(b), s(a), -c(a) * c(b))
    d_a, d_b = ca.vertcat(s(a) * s(b), c(a), s(a) * c(b)), ca.vertcat(-c(a) * c(b), 0, c(a) * s(b))
    reduced_kg = QUADROTOR_KG * LOAD_KG / (QUADROTOR_KG + LOAD_KG)
    tension = reduced_kg * (CABLE_M * (da**2 + c(a) ** 2 * db**2) - specific * ca.dot(d, b3))
    acceleration = specific * b3 + tension * d / QUADROTOR_KG - ca.vertcat(0, 0, G_MPS2)
    dda = -(specific * ca.dot(d_a, b3) / CABLE_M + s(a) * c(a) * db**2)
    ddb = -(specific * ca.dot(d_b, b3) / (CABLE_M * c(a) ** 2) - 2 * ca.tan(a) * da * db)
    roll, pitch = ARM_M * (-u[0] + u[1] + u[2] - u[3]), ARM_M * (-u[0] - u[1] + u[2] + u[3])
    yaw = YAW_M * (u[0] - u[1] + u[2] - u[3])
    i_x, i_y, i_z = INERTIA_KGM2
    spin = ca.vertcat((roll - (i_z - i_y) * q * r) / i_x, (pitch - (i_x - i_z) * p * r) / i_y, (yaw - (i_y - i_x) * p * q) / i_z)
    turning = q * s(phi) + r * c(phi)
    euler = ca.vertcat(turning / c(theta), q * c(phi) - r * s(phi), p + turning * ca.tan(theta))
    f = ca.vertcat(velocity, euler, da, db, acceleration, spin, dda, ddb)
    return ca.Function("f", [x, u], [f]), ca.Function("tension", [x, u], [tension])


def shoot(f):
    x, u, h = ca.SX.sym("x", 16), ca.SX.sym("u", 4), ca.SX.sym("h")
    y = x
    for _ in range(STEPS_PER_INTERVAL):
        k1 = f(y, u)
        k2 = f(y + h / 2 * k1, u)
        k3 = f(y + h / 2 * k2, u)
        k4 = f(y + h * k3, u)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return ca.Function("shoot", [x, u, h], [y])


def distance_to_block(x, y):
    r = np.sqrt(0.5)
    qx, qy = ca.fabs(r * (x - y)) - 1.5, ca.fabs(r * (x + y)) - 1.0
    return ca.sqrt(ca.fmax(qx, 0) ** 2 + ca.fmax(qy, 0) ** 2 + 1e-12) + ca.fmin(ca.fmax(qx, qy), 0)


def solve(case, seed):
    """The minimum time from one start, s; None if the method does not converge."""
    start, goal, has_block = CASES[case]
    f, tension = dynamics()
    n, rng, problem = INTERVALS, np.random.default_rng(seed), ca.Opti()
    x, u, duration = problem.variable(16, n + 1), problem.variable(4, n), problem.variable()
    steps = shoot(f).map(n)(x[:, :n], u, ca.repmat(duration / n / STEPS_PER_INTERVAL, 1, n))
    problem.subject_to(ca.vec(x[:, 1:] - steps) == 0)
    problem.subject_to(x[:, 0] == np.array([*start, *[0] * 13]))
    problem.subject_to(x[:, n] == np.array([*goal, *[0] * 13]))
    problem.subject_to(problem.bounded(THRUST_N[0], ca.vec(u), THRUST_N[1]))
    problem.subject_to(problem.bounded(-EULER_RAD, ca.vec(x[3:6, 1:n]), EULER_RAD))
    problem.subject_to(problem.bounded(-CABLE_RAD, ca.vec(x[6:8, 1:n]), CABLE_RAD))
    problem.subject_to(problem.bounded(0.5, duration, 8))
    for at in (x[:, :n], x[:, 1:]):
        problem.subject_to(ca.vec(tension.map(n)(at, u)) >= 0)
    if has_block:
        gap = distance_to_block(x[0, 1:n], x[1, 1:n]) - CLEARANCE_M
        problem.subject_to(gap >= RADIUS_M)
        for reach in (ca.cos(x[6, 1:n]) * ca.sin(x[7, 1:n]), ca.sin(x[6, 1:n])):
            problem.subject_to(gap >= np.sqrt(2) * CABLE_M * reach)
            problem.subject_to(gap >= -np.sqrt(2) * CABLE_M * reach)
    problem.minimize(duration)
    t = np.linspace(0, 1, n + 1)
    along = 10 * t**3 - 15 * t**4 + 6 * t**5
    guess, guess_s = np.zeros((16, n + 1)), rng.uniform(2.0, 4.0)
    guess[:3] = np.array(start)[:, None] + np.subtract(goal, start)[:, None] * along
    side = 1 if seed % 2 else -1
    guess[1] += side * rng.uniform(1.6, 2.6) * np.sin(np.pi * along) * has_block
    if seed >= 2:
        for i in range(3, 8):
            guess[i] = rng.uniform(-0.5, 0.5) * np.sin(np.pi * t * rng.integers(1, 4))
    guess[8:11, :n] = np.diff(guess[:3]) / (guess_s / n)
    problem.set_initial(x, guess)
    problem.set_initial(u, (QUADROTOR_KG + LOAD_KG) * G_MPS2 / 4)
    problem.set_initial(duration, guess_s)
    problem.solver("ipopt", {"print_time": 0}, {"print_level": 0, "max_iter": 500, "tol": 1e-6, "sb": "yes"})
    try:
        return side, float(problem.solve().value(duration))
    except RuntimeError:
        return side, None


def main():
    starts = int(sys.argv[1]) if len(sys.argv) > 1 else 8
    for case in CASES:
        found = [solve(case, seed) for seed in range(starts)]
        for name, side in (("left", 1), ("right", -1)):
            times = sorted(t for s, t in found if s == side and t is not None)
            if times:
                print(f"{case} {name}: {times[0]:.5f} s, from {len(times)} of {starts // 2} starts; largest {times[-1]:.5f} s", flush=True)


if __name__ == "__main__":
    main()
