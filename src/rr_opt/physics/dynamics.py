"""The equation of motion and the servo torque, by Kane's method, for any set of effects.

Row v of Kane's equations (`kane`), with the axles held, is the equation of motion; the other rows
give the side forces and the torque. `tests/physics` holds the result against the paper's closed
form, whose printed equation (3) has sign errors, and against Lagrange multipliers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.outcome import InputError
from rr_opt.physics.assembly import assembled, values_of
from rr_opt.physics.kane import equations
from rr_opt.physics.kinematics import SPEEDS, Mechanism
from rr_opt.physics.steady_effects import steady_effects
from rr_opt.physics.tried import affine, mirrored
from rr_opt.robot.parameters import Robot


@dataclass(frozen=True)
class Dynamics:
    """The derived model as CasADi functions; `p` stacks the values of `parameters`.

    effects  those that have a place in a steady cycle; see `steady_effects`
    motion   (v, phi, dphi, ddphi, p) -> vdot, w, side, torque: acceleration of axle 1 along
             platform 1 (m/s2), yaw rate psi-dot (rad/s), velocity of P to the left of platform
             1's axis (m/s), servo torque (N m). P moves at v along the axis.
    energy   (v, phi, dphi, p) -> kinetic (J), dissipation (W, the paper's 2R)
    sides    (v, phi, dphi, ddphi, p) -> F1, F2: side forces on the axles, N
    linear   vdot is affine in v, so the steady cycle is one linear fixed point
    mirrored the mirror image of a motion is a motion: gaits at offsets phi0 and -phi0 are alike
    """

    effects: tuple[str, ...]
    parameters: tuple[str, ...]
    motion: ca.Function
    energy: ca.Function
    sides: ca.Function
    linear: bool
    mirrored: bool

    def values(self, robot: Robot) -> NDArray[np.float64]:
        """The parameter vector p of a robot that has these effects, SI."""
        return values_of(robot, self.parameters)

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


def derive(effects: tuple[str, ...] = ()) -> Dynamics:
    """Derive the model with those of the named effects that have a place in a steady cycle."""
    return _derived(tuple(name for name in effects if name in steady_effects()))


@lru_cache
def _derived(effects: tuple[str, ...]) -> Dynamics:
    assembly = assembled(effects)
    return _held(assembly.mechanism, effects, assembly.parameters, assembly.p)


def _held(robot: Mechanism, effects: tuple[str, ...], names: tuple[str, ...], p: ca.SX) -> Dynamics:
    phi, u = robot.phi, robot.speeds
    kane = equations(robot)
    needed = ca.substitute(kane.needed, kane.udot[1:3], ca.SX.zeros(2))
    vdot, ddphi = kane.udot[0], kane.udot[3]

    # The axles do not slip: s1 = s2 = 0 from here on. Row v is linear in vdot.
    held = ca.vertcat(*(u[SPEEDS.index(name)] for name in sorted(robot.held)))
    needed, kinetic, power, w, ahead, side = (
        ca.substitute(part, held, ca.SX.zeros(held.numel()))
        for part in (needed, kane.kinetic, kane.power, kane.rate, kane.joint[0], kane.joint[1])
    )
    inertia = ca.jacobian(needed[0], vdot)
    solved = -ca.substitute(needed[0], vdot, ca.SX(0)) / inertia
    needed = ca.substitute(needed, vdot, solved)

    # Axle 1 may roll at an angle to its platform's axis; from here on v counts along the axis.
    v, dphi = u[0], u[SPEEDS.index("dphi")]
    share = ca.jacobian(ahead, v)
    solved, needed, kinetic, power, w, side = (
        ca.substitute(part, v, v / share)
        for part in (share * solved, needed, kinetic, power, w, side)
    )
    inputs = [v, phi, dphi, ddphi, p]
    names_in = ["v", "phi", "dphi", "ddphi", "p"]
    outputs = _tidy(solved, w, side, needed[3])
    motion = ca.Function("motion", inputs, outputs, names_in, ["vdot", "w", "side", "torque"])
    return Dynamics(
        effects=effects,
        parameters=names,
        motion=motion,
        energy=ca.Function(
            "energy",
            [v, phi, dphi, p],
            _tidy(kinetic, -power),
            ["v", "phi", "dphi", "p"],
            ["kinetic", "dissipation"],
        ),
        sides=ca.Function("sides", inputs, _tidy(needed[1], needed[2]), names_in, ["F1", "F2"]),
        linear=affine(ca.Function("vdot", inputs, [solved])),
        mirrored=mirrored(motion),
    )


def _tidy(*expressions: ca.SX) -> list[ca.SX]:
    """The same expressions with common parts computed once."""
    return ca.vertsplit(ca.cse(ca.vertcat(*expressions)))
