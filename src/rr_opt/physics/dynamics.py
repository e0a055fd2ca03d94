"""The equation of motion and the servo torque, by Kane's method, for any set of effects.

Speeds. Any motion of the mechanism is named by four quasi-speeds: u = (v, s1, s2, dphi), the
speed of axle 1 along its rolling direction, the side speeds of both axles, and the servo's
rate. Velocities are linear in them, qd = G(q) u, with G the inverse of the rows that define
the speeds. Without side slip s1 = s2 = 0 (the paper's constraints 1 and 2).

Equations. With T(q, qd) the kinetic energy and Q the generalised applied forces,

    G' [ d/dt dT/dqd - dT/dq - Q ] = (0, F1, F2, torque)

Row v is the equation of motion, rows s1 and s2 give the side forces that hold the axles, and
row dphi gives the servo torque, which acts on platform 2 and reacts on platform 1. Nothing is
transcribed: `tests/physics` holds the result against the paper's closed form, whose printed
equation (3) has sign errors, and against a model with Lagrange multipliers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.effects import CATALOGUE
from rr_opt.physics.kinematics import ROBOT_PARAMETERS, Mechanism, mechanism, robot_values
from rr_opt.robot.parameters import Robot


@dataclass(frozen=True)
class Dynamics:
    """The derived model as CasADi functions; `p` stacks the values of `parameters`.

    motion  (v, phi, dphi, ddphi, p) -> vdot, w, side, torque: acceleration of axle 1 along
            platform 1 (m/s2), yaw rate psi-dot (rad/s), velocity of P to the left of platform
            1's axis (m/s), servo torque (N m). P moves at v along the axis.
    energy  (v, phi, dphi, p) -> kinetic (J), dissipation (W, the paper's 2R)
    sides   (v, phi, dphi, ddphi, p) -> F1, F2: side forces on the axles, N
    linear  vdot is affine in v, so the steady cycle is one linear fixed point
    """

    effects: tuple[str, ...]
    parameters: tuple[str, ...]
    motion: ca.Function
    energy: ca.Function
    sides: ca.Function
    linear: bool

    def values(self, robot: Robot) -> NDArray[np.float64]:
        """The parameter vector p of a robot that has these effects, SI."""
        chosen = {use.name: use.values for use in robot.physics}
        beyond = (
            chosen[name][parameter.name]
            for name in self.effects
            for parameter in CATALOGUE[name].parameters
        )
        return np.array([*robot_values(robot), *beyond])


def dynamics_of(robot: Robot) -> Dynamics:
    """The model with the effects that the robot lists."""
    return derive(tuple(use.name for use in robot.physics))


@lru_cache
def derive(effects: tuple[str, ...] = ()) -> Dynamics:
    """Derive the model with the named effects of the catalogue."""
    robot = mechanism()
    symbols = [robot.parameters[name] for name in ROBOT_PARAMETERS]
    names = list(ROBOT_PARAMETERS)
    for name in effects:
        effect = CATALOGUE[name]
        values = {q.name: ca.SX.sym(f"{name}.{q.name}") for q in effect.parameters}
        robot = effect.enter(robot, values)
        symbols += values.values()
        names += [f"{name}.{parameter}" for parameter in values]

    return _kane(robot, effects, tuple(names), ca.vertcat(*symbols))


def _kane(
    robot: Mechanism, effects: tuple[str, ...], names: tuple[str, ...], p: ca.SX
) -> Dynamics:
    q, qd = robot.q, robot.qd
    W = _speed_rows(robot)
    kinetic = robot.spin + sum(
        body.mass * ca.sumsqr(robot.velocity(body.centre)) / 2
        + body.inertia * ca.jtimes(body.angle, q, qd) ** 2 / 2
        for body in robot.bodies
    )
    momentum = ca.gradient(kinetic, qd)
    M = ca.jacobian(momentum, qd)
    bias = ca.jtimes(momentum, q, qd) - ca.gradient(kinetic, q)
    speeds = [robot.velocity(force.point) for force in robot.forces]
    Q = sum(
        ca.jtimes(speed, qd, force.vector, True)
        for speed, force in zip(speeds, robot.forces, strict=True)
    )
    power = sum(
        ca.dot(speed, force.vector) for speed, force in zip(speeds, robot.forces, strict=True)
    )
    drift = ca.jtimes(W @ qd, q, qd)

    # Nothing depends on where the robot stands or heads, so take x = y = psi = 0: what is left
    # after CasADi has folded the zeros and ones is the motion seen from platform 1.
    v, phi, dphi, ddphi = (ca.SX.sym(name) for name in ("v", "phi", "dphi", "ddphi"))
    here = ca.vertcat(0, 0, 0, phi)
    G = ca.inv_minor(ca.substitute(W, q, here))
    speed = ca.vertcat(v, 0, 0, dphi)
    M, bias, Q, drift, kinetic, power = (
        ca.substitute(part, ca.vertcat(q, qd), ca.vertcat(here, G @ speed))
        for part in (M, bias, Q, drift, kinetic, power)
    )
    forward = G[:, 0]
    rest = M @ (G @ (ca.vertcat(0, 0, 0, ddphi) - drift)) + bias - Q
    vdot = -ca.dot(forward, rest) / ca.dot(forward, M @ forward)
    needed = G.T @ (rest + M @ forward * vdot)
    velocity = G @ speed

    vdot, w, side, torque = _tidy(vdot, velocity[2], velocity[1], needed[3])
    inputs = [v, phi, dphi, ddphi, p]
    names_in = ["v", "phi", "dphi", "ddphi", "p"]
    return Dynamics(
        effects=effects,
        parameters=names,
        motion=ca.Function(
            "motion", inputs, [vdot, w, side, torque], names_in, ["vdot", "w", "side", "torque"]
        ),
        energy=ca.Function(
            "energy",
            [v, phi, dphi, p],
            _tidy(kinetic, -power),
            ["v", "phi", "dphi", "p"],
            ["kinetic", "dissipation"],
        ),
        sides=ca.Function("sides", inputs, _tidy(needed[1], needed[2]), names_in, ["F1", "F2"]),
        linear=_affine(ca.Function("vdot", inputs, [vdot])),
    )


def _affine(vdot: ca.Function) -> bool:
    """Whether vdot is affine in v, found by trying.

    Terms in v^2 cancel between the bodies, but only once sines and cosines are multiplied out,
    which CasADi does not do; so the second difference in v is looked at in numbers.
    """
    p = np.linspace(0.5, 1.5, vdot.numel_in(4))
    for phi, dphi, ddphi in ((0.3, 1.0, -2.0), (-1.1, 0.7, 3.0), (0.8, -2.0, 0.5)):
        low, middle, high = (float(vdot(v, phi, dphi, ddphi, p)) for v in (-1.0, 0.0, 1.0))
        if abs(low - 2 * middle + high) > 1e-9 * (abs(low) + abs(middle) + abs(high)):
            return False
    return True


def _speed_rows(robot: Mechanism) -> ca.SX:
    """W(q), 4x4, with u = W qd the quasi-speeds (v, s1, s2, dphi)."""
    first, second = robot.axles
    at_first = ca.jacobian(robot.velocity(first.centre), robot.qd)
    at_second = ca.jacobian(robot.velocity(second.centre), robot.qd)
    return ca.vertcat(
        first.along.T @ at_first,
        first.across.T @ at_first,
        second.across.T @ at_second,
        ca.SX([[0, 0, 0, 1]]),
    )


def _tidy(*expressions: ca.SX) -> list[ca.SX]:
    """The same expressions with common parts computed once."""
    return ca.vertsplit(ca.cse(ca.vertcat(*expressions)))
