"""The steady cycle by CasADi's cvodes, and the speed from where P goes: for tests alone.

The speed is R |turn|/T about the centre that one period's motion leaves in place, so neither
the Fourier series nor the formula of the mean velocity comes in.
"""

from functools import lru_cache
from typing import NamedTuple

import casadi as ca
import numpy as np

from rr_opt.motion.dynamics import derive

SAMPLES = 2000


class Reference(NamedTuple):
    """Signed speed (m/s), turn per period (rad), peak torque (N m)."""

    speed: float
    turn: float
    peak_torque: float


@lru_cache
def integrator(effects):
    """States v, x, y, psi, the mean of P and of the heading in a frame turning at `rate`."""
    model = derive(effects)
    p = ca.SX.sym("p", len(model.parameters))
    gait, frame, t = ca.SX.sym("gait", 3), ca.SX.sym("frame", 3), ca.SX.sym("t")
    v, x, y, psi = (ca.SX.sym(name) for name in ("v", "x", "y", "psi"))
    means = ca.SX.sym("means", 4)
    alpha, T, phi0 = ca.vertsplit(gait)
    omega = 2 * np.pi / T
    angle = (
        alpha * ca.sin(omega * t) + phi0,
        alpha * omega * ca.cos(omega * t),
        -alpha * omega**2 * ca.sin(omega * t),
    )
    vdot, w, side, torque = model.motion(v, *angle, p)
    rate, xc, yc = ca.vertsplit(frame)
    c, s = ca.cos(rate * t), ca.sin(rate * t)
    dx, dy = x - xc, y - yc
    ode = ca.vertcat(
        vdot,
        v * ca.cos(psi) - side * ca.sin(psi),
        v * ca.sin(psi) + side * ca.cos(psi),
        w,
        (c * dx + s * dy) / T,
        (c * dy - s * dx) / T,
        ca.cos(psi - rate * t) / T,
        ca.sin(psi - rate * t) / T,
    )
    states = ca.vertcat(v, x, y, psi, means)
    inputs = ca.vertcat(p, gait, frame)
    # The period is scaled to 1, for the end of the integration is fixed when it is built.
    tau = ca.SX.sym("tau")
    dae = {"x": states, "p": inputs, "t": tau, "ode": T * ca.substitute(ode, t, tau * T)}
    options = {"abstol": 1e-13, "reltol": 1e-12, "max_num_steps": 200_000}
    grid = np.linspace(0, 1, SAMPLES + 1)
    run = ca.integrator("run", "cvodes", dae, 0, grid, options)
    at = ca.Function("torque", [v, t, p, gait], [torque])
    return model, run, at


def reference(robot, gait):
    """The steady cycle of a robot's gait (amplitude, period, offset)."""
    model, run, torque_at = integrator(tuple(use.name for use in robot.physics))
    p = model.values(robot)

    def period(v0, frame=(0.0, 0.0, 0.0)):
        return np.array(run(x0=[v0, *[0.0] * 7], p=[*p, *gait, *frame])["xf"])

    v0, v1 = 0.0, 0.01
    gap0, gap1 = (period(v)[0, -1] - v for v in (v0, v1))
    for _ in range(30):
        v0, v1 = v1, v1 - gap1 * (v1 - v0) / (gap1 - gap0)
        gap0, gap1 = gap1, period(v1)[0, -1] - v1
        if abs(gap1) < 1e-12 or gap1 == gap0:
            break
    T, path = gait[1], period(v1)
    v, x, y, psi = path[:4]
    turn, chord = psi[-1], complex(x[-1], y[-1])
    rate = turn / T
    if abs(turn) < 1e-7:
        velocity = chord / T
        heading = np.exp(1j * psi[:-1]).mean()
    else:
        centre = chord / (1 - np.exp(1j * turn))
        means = period(v1, (rate, centre.real, centre.imag))[4:, -1]
        velocity, heading = 1j * rate * complex(*means[:2]), complex(*means[2:])
    speed = np.copysign(abs(velocity), (velocity * heading.conjugate()).real)
    times = np.linspace(0, T, SAMPLES + 1)
    torque = np.abs([float(torque_at(a, b, p, gait)) for a, b in zip(v, times, strict=True)])
    return Reference(float(speed), float(turn), parabola(torque[:-1]))


def parabola(size):
    """The largest of evenly spaced samples of a period, between them too."""
    k = int(size.argmax())
    left, middle, right = size[k - 1], size[k], size[(k + 1) % len(size)]
    return middle - (right - left) ** 2 / (8 * (left - 2 * middle + right))
