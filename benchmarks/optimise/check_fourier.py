"""Holds the numpy steady cycle against equations of motion written another way.

The other way: both platforms as rigid bodies in the plane with the coordinates x, y, psi and
phi, the two axles' side-slip conditions as Lagrange multipliers and the torque as the force
that makes phi follow the gait, all from one linear system for the accelerations; integrated
by solve_ivp to a relative 1e-12. Nothing is eliminated by hand.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.optimise.bodies import body
from benchmarks.optimise.fourier_numpy import evaluate, steady_cycle
from rr_opt.model.robot import Platform, Robot


def unit(angle: float) -> tuple[np.ndarray, np.ndarray]:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c, s]), np.array([-s, c])


def accelerations(robot: Robot, t: float, y: np.ndarray, gait: tuple) -> tuple[np.ndarray, float]:
    """(xdd, ydd, psidd) and the torque at the state y = (x, y, psi, xd, yd, psid)."""
    alpha, T, phi0 = gait
    om = 2 * math.pi / T
    phi, dphi = alpha * math.sin(om * t) + phi0, alpha * om * math.cos(om * t)
    rate = np.array([*y[3:], dphi])
    M, force, rows, gamma = np.zeros((4, 4)), np.zeros(4), [], []
    for p, k, psi, sign, turns in (
        (robot.platform1, robot.k1, y[2], 1.0, (1.0, 0.0)),
        (robot.platform2, robot.k2, y[2] + phi, -1.0, (1.0, 1.0)),
    ):
        e, n = unit(psi)
        spin = np.array([0.0, 0.0, *turns])
        w = spin @ rate

        def point(r, side, axes=(e, n), spin=spin, w=w):
            """Jacobian and centripetal acceleration of P + r e + side n."""
            e, n = axes
            J = np.outer(r * n - side * e, spin)
            J[:, :2] += np.eye(2)
            return J, -(w**2) * (r * e + side * n)

        J, drift = point(sign * (p.c - p.a), 0.0)
        M += p.m * J.T @ J + p.I * np.outer(spin, spin)
        force -= p.m * J.T @ drift
        for side in (p.b, -p.b):
            J, _ = point(sign * p.c, side)
            force -= k * (e @ J @ rate) * (e @ J)
        J, drift = point(sign * p.c, 0.0)
        rows.append(n @ J)  # n . velocity = 0, and its derivative:
        gamma.append(-(n @ drift) + w * (e @ J @ rate))
    A = np.array([*rows, [0.0, 0.0, 0.0, 1.0]])
    K = np.block([[M, -A.T], [A, np.zeros((3, 3))]])
    x = np.linalg.solve(K, [*force, *gamma, -alpha * om**2 * math.sin(om * t)])
    return x[:3], x[6]


def start(robot: Robot, gait: tuple, v: float) -> np.ndarray:
    """The state at t = 0 with psi = 0, forward speed v of axle 1 and no side slip."""
    alpha, T, phi0 = gait
    c1, c2, dphi = robot.platform1.c, robot.platform2.c, alpha * 2 * math.pi / T
    w = -(v * math.sin(phi0) + c2 * dphi) / (c1 * math.cos(phi0) + c2)
    return np.array([0.0, 0.0, 0.0, v, -c1 * w, w])


def shoot(robot: Robot, gait: tuple, v: float, turns: float = 1.0):
    def rhs(t, y):
        return np.concatenate([y[3:], accelerations(robot, t, y, gait)[0]])

    y0, T = start(robot, gait, v), gait[1]
    return solve_ivp(rhs, (0, turns * T), y0, "DOP853", rtol=1e-12, atol=1e-13, dense_output=True)


def forward_speed(y: np.ndarray) -> float:
    return y[3] * np.cos(y[2]) + y[4] * np.sin(y[2])


def steady_by_shooting(robot: Robot, gait: tuple, nodes: int):
    """Mean speed, turn and the torque at the nodes: v(T) is affine in v(0), so two shots suffice.

    R is the length of the mean vector from the fixed centre, seen in the steadily turning frame.
    """
    ends = [forward_speed(shoot(robot, gait, v).y[:, -1]) for v in (0.0, 0.1)]
    v0 = ends[0] / (1 - (ends[1] - ends[0]) / 0.1)
    run, T = shoot(robot, gait, v0), gait[1]
    t = np.arange(nodes) * T / nodes
    y = run.sol(t)
    torque = np.array([accelerations(robot, a, b, gait)[1] for a, b in zip(t, y.T, strict=True)])
    end, turn = run.y[:, -1], run.y[2, -1]
    chord = end[0] + 1j * end[1]
    velocity, heading = chord / T, np.mean(np.exp(1j * (y[2] - turn * t / T)))
    if abs(turn) > 1e-7:
        centre = chord / (1 - np.exp(1j * turn))
        arm = np.mean((y[0] + 1j * y[1] - centre) * np.exp(-1j * turn * t / T))
        velocity = 1j * arm * turn / T
    return np.copysign(abs(velocity), (velocity * np.conj(heading)).real), turn, torque


def energy_residual(robot: Robot, gait: tuple, nodes: int = 256) -> float:
    """The largest |torque dphi - d(energy)/dt - dissipation| over the cycle, relative."""
    alpha, T, phi0 = gait
    one, two = body(robot.platform1, robot.k1), body(robot.platform2, robot.k2)
    cycle = steady_cycle(one, two, [np.array([[x]]) for x in gait], nodes, True)
    turn = 2 * np.pi * np.arange(nodes) / nodes
    phi, q = alpha * np.sin(turn) + phi0, alpha * 2 * np.pi / T * np.cos(turn)
    v, w, w2 = cycle.v[0], cycle.w[0], cycle.w[0] + q
    u2 = v * np.cos(phi) - one.c * w * np.sin(phi)  # P's velocity along e2
    energy = (one.m * v**2 + one.J * w**2 + two.m * u2**2 + two.J * w2**2) / 2
    lost = 2 * one.k * (v**2 + (one.b * w) ** 2) + 2 * two.k * (u2**2 + (two.b * w2) ** 2)
    slope = np.fft.irfft(np.fft.rfft(energy) * 2j * np.pi / T * np.arange(nodes // 2 + 1), nodes)
    power = cycle.torque[0] * q
    return np.max(np.abs(power - slope - lost)) / np.max(np.abs(power))


def random_robot(rng: np.random.Generator) -> Robot:
    def platform(m, inertia, c):
        f = rng.uniform(0.7, 1.3, 6)
        return Platform(m * f[0], inertia * f[1], c * f[2], 0.05 * f[3], 0.05 * f[4], 2e-5 * f[5])

    return Robot(platform(0.469, 0.00386, 0.236), platform(0.25, 0.00175, 0.0941), h=0.02)


def main(gaits: int = 6, seed: int = 1) -> None:
    rng = np.random.default_rng(seed)
    print("  alpha      T   phi0 |  speed m/s     turn | errors: speed    turn   torque   energy")
    for n in range(gaits):
        robot = random_robot(rng)
        if n % 2:
            robot = replace(robot, platform1=replace(robot.platform1, kappa=4e-6))
        gait = (rng.uniform(0.3, 1.3), rng.uniform(0.4, 2), rng.uniform(-0.3, 0.3) * (n > 1))
        got = evaluate(robot, None, (*gait, np.nan), nodes=256)
        speed, turn, torque = steady_by_shooting(robot, gait, 256)
        two = body(robot.platform2, robot.k2)
        columns = [np.array([[x]]) for x in gait]
        cycle = steady_cycle(body(robot.platform1, robot.k1), two, columns, 256, True)
        errors = (
            abs(got.speed[0] / speed - 1),
            abs(got.turn[0] - turn),
            np.max(np.abs(cycle.torque[0] - torque)) / np.max(np.abs(torque)),
            energy_residual(robot, gait),
        )
        what = "".join(f"{x:7.3f}" for x in gait)
        print(f"{what} |{got.speed[0]:11.7f}{got.turn[0]:9.4f} |       ", end="")
        print("".join(f"{x:9.1e}" for x in errors))
        if max(errors) > 1e-7:
            raise SystemExit("The numpy steady cycle disagrees with the integrated motion.")


if __name__ == "__main__":
    main()
