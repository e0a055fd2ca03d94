"""The equation of motion and the servo torque, by Kane's method, for any set of effects.

With u = (v, s1, s2, dphi) the speeds of `kinematics`, every velocity and rate of the mechanism is
a function of phi and u, linear in u. A body of mass m whose centre moves at V, seen from a
platform that turns at w, accelerates by dV/dt + w x V; a rotor of inertia I turning at w by
dw/dt. Kane's equation for speed j equates what they need with what forces F and the servo give:

    sum m (dV/dt + w x V) . dV/du_j + sum I dw/dt dw/du_j = sum F . dV/du_j + (0, F1, F2, torque)_j

Row v is the equation of motion, rows s1 and s2 give the side forces that hold the axles, and
row dphi gives the servo torque, which acts on platform 2 and reacts on platform 1. All partial
velocities and rates of change are CasADi's; `tests/physics` holds the result against the paper's
closed form, whose printed equation (3) has sign errors, and against Lagrange multipliers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.outcome import InputError
from rr_opt.physics.effects import CATALOGUE
from rr_opt.physics.kinematics import (
    ROBOT_PARAMETERS,
    SPEEDS,
    Mechanism,
    mechanism,
    robot_values,
)
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

    def dissipates(self, robot: Robot) -> bool:
        """Whether motion costs the robot energy; without that no gait ever settles."""
        p = self.values(robot)
        return any(float(self.energy(1.0, phi, 1.0, p)[1]) > 0 for phi in (0.0, 0.3))


def dynamics_of(robot: Robot) -> Dynamics:
    """The model with the effects that the robot lists."""
    return derive(tuple(use.name for use in robot.physics))


def require_friction(robot: Robot) -> None:
    """Raise InputError for a robot that no gait brings to a steady speed."""
    if not dynamics_of(robot).dissipates(robot):
        raise InputError(
            "The robot has no friction: kappa (or k) is 0 on both platforms, and `physics` adds "
            "none. Without friction no gait settles to a steady speed. Give at least one platform "
            "a kappa above 0."
        )


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


def _kane(robot: Mechanism, effects: tuple[str, ...], names: tuple[str, ...], p: ca.SX) -> Dynamics:
    phi, u = robot.phi, robot.speeds
    vdot, ddphi = ca.SX.sym("vdot"), ca.SX.sym("ddphi")
    udot = ca.vertcat(vdot, 0, 0, ddphi)

    def change(quantity: ca.SX) -> ca.SX:
        return ca.jtimes(quantity, phi, u[SPEEDS.index("dphi")]) + ca.jtimes(quantity, u, udot)

    needed = ca.SX.zeros(len(SPEEDS))
    kinetic = ca.SX(0)
    for body in robot.bodies:
        frame = robot.frames[body.platform]
        V = frame.velocity(body.point)
        acceleration = change(V) + frame.rate * ca.vertcat(-V[1], V[0])
        needed += ca.jtimes(V, u, body.mass * acceleration, True)
        kinetic += body.mass * ca.sumsqr(V) / 2
    for rotor in robot.rotors:
        needed += ca.jtimes(rotor.rate, u, rotor.inertia * change(rotor.rate), True)
        kinetic += rotor.inertia * rotor.rate**2 / 2
    power = ca.SX(0)
    for force in robot.forces:
        V = robot.frames[force.platform].velocity(force.point)
        needed -= ca.jtimes(V, u, force.vector, True)
        power += ca.dot(V, force.vector)

    # The axles do not slip: s1 = s2 = 0 from here on. Row v is linear in vdot.
    here = [robot.frames[1].rate, robot.parameters["c1"] * -robot.frames[1].rate]
    held = ca.vertcat(*(u[SPEEDS.index(name)] for name in sorted(robot.held)))
    needed, kinetic, power, w, side = (
        ca.substitute(part, held, ca.SX.zeros(held.numel()))
        for part in (needed, kinetic, power, *here)
    )
    inertia = ca.jacobian(needed[0], vdot)
    solved = -ca.substitute(needed[0], vdot, ca.SX(0)) / inertia
    needed = ca.substitute(needed, vdot, solved)

    v, dphi = u[0], u[SPEEDS.index("dphi")]
    inputs = [v, phi, dphi, ddphi, p]
    names_in = ["v", "phi", "dphi", "ddphi", "p"]
    motion = _tidy(solved, w, side, needed[3])
    return Dynamics(
        effects=effects,
        parameters=names,
        motion=ca.Function("motion", inputs, motion, names_in, ["vdot", "w", "side", "torque"]),
        energy=ca.Function(
            "energy",
            [v, phi, dphi, p],
            _tidy(kinetic, -power),
            ["v", "phi", "dphi", "p"],
            ["kinetic", "dissipation"],
        ),
        sides=ca.Function("sides", inputs, _tidy(needed[1], needed[2]), names_in, ["F1", "F2"]),
        linear=_affine(ca.Function("vdot", inputs, [solved])),
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


def _tidy(*expressions: ca.SX) -> list[ca.SX]:
    """The same expressions with common parts computed once."""
    return ca.vertsplit(ca.cse(ca.vertcat(*expressions)))
