"""The equation of motion and the servo torque in a gait's steady cycle, for any set of effects.

Row v of Kane's equations (`mechanics.kane`), with the axles constrained, is the equation of motion;
the other rows give the side forces and the torque. `tests/mechanics` checks the result against the
paper's closed form, whose printed equation (3) has sign errors, and against Lagrange multipliers.

In a steady cycle the axles do not slip, every place and heading is like any other, and the joint
follows its command. Effects that contradict this have no steady cycle and are ignored here: what
the servo makes of its command, what the floor does in one place and not another, and what the
capture system makes of the motion.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.effects import CATALOGUE
from rr_opt.effects.effect import Port
from rr_opt.mechanics.kane import equations
from rr_opt.mechanics.kinematics import (
    ROBOT_PARAMETERS,
    SPEEDS,
    Mechanism,
    Observation,
    mechanism,
    robot_values,
    wheel_loads,
)
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError

_ORDER = (Port.CONSTRAINT, Port.MASS, Port.FORCE, Port.ACTUATION, Port.MEASUREMENT)
"""What turns the axles enters first, as every force depends on them."""
_LISTED = tuple(CATALOGUE)


@dataclass(frozen=True)
class Assembly:
    """A mechanism with effects, over symbols.

    effects      as they were asked for
    observation  what a capture system records of it
    parameters   names: ROBOT_PARAMETERS, then `effect.parameter` of each effect that enters
    p            their symbols, stacked
    """

    effects: tuple[str, ...]
    mechanism: Mechanism
    observation: Observation
    parameters: tuple[str, ...]
    p: ca.SX


def assembled(
    effects: tuple[str, ...], *, neutral: frozenset[str] = frozenset(), for_prediction: bool = False
) -> Assembly:
    """The paper's robot with those of the named effects that change it or how it is observed.

    neutral: `effect.parameter` of those that count as neutral whatever p says, so that what they
    scale is not worked out.
    """
    robot = replace(mechanism(), for_prediction=for_prediction)
    observation = Observation(robot.pose[0], robot.pose[1], robot.pose[2], robot.phi)
    symbols = {name: robot.parameters[name] for name in ROBOT_PARAMETERS}
    for name in sorted(
        effects, key=lambda name: (_ORDER.index(CATALOGUE[name].port), _LISTED.index(name))
    ):
        effect = CATALOGUE[name]
        own = {f"{name}.{q.name}": ca.SX.sym(f"{name}.{q.name}") for q in effect.parameters}
        values = {
            q.name: ca.SX(q.neutral) if key in neutral else own[key]
            for q, key in zip(effect.parameters, own, strict=True)
        }
        if effect.enter:
            robot = effect.enter(robot, values)
        elif effect.observe:
            observation = effect.observe(observation, values)
        else:
            continue
        symbols |= own
    return Assembly(effects, robot, observation, tuple(symbols), ca.vertcat(*symbols.values()))


def values_of(robot: Robot, parameters: tuple[str, ...]) -> NDArray[np.float64]:
    """The values of an assembly's parameters for a robot that has its effects, SI.

    A parameter of an effect that the robot does not give is neutral.
    """
    values = dict(zip(ROBOT_PARAMETERS, robot_values(robot), strict=True)) | {
        f"{use.name}.{q.name}": use.values.get(q.name, q.neutral)
        for use in robot.physics
        for q in CATALOGUE[use.name].parameters
    }
    return np.array([values[name] for name in parameters])


@lru_cache
def steady_effects() -> frozenset[str]:
    """The effects that have a steady cycle."""

    def steady(name: str) -> bool:
        robot = assembled((name,)).mechanism
        placed = any(ca.depends_on(force.vector, robot.pose) for force in robot.forces)
        return len(robot.constrained) == 2 and not placed and robot.creep is None

    return frozenset(name for name, effect in CATALOGUE.items() if effect.enter and steady(name))


def ignored_in_steady_cycle(robot: Robot, port: Port | None = None) -> tuple[str, ...]:
    """The robot's effects, of one port or all, that a steady cycle ignores."""
    names = [use.name for use in robot.physics if use.name not in steady_effects()]
    return tuple(name for name in names if port in (None, CATALOGUE[name].port))


@dataclass(frozen=True)
class Dynamics:
    """The derived model as CasADi functions; p stacks the values of `parameters`.

    effects  those that have a steady cycle
    motion   (v, phi, dphi, ddphi, p) -> vdot, w, side, torque: acceleration of axle 1 along
             platform 1 (m/s2), yaw rate psi-dot (rad/s), velocity of P to the left of platform
             1's axis (m/s), servo torque (N m). P moves at v along the axis.
    energy   (v, phi, dphi, p) -> kinetic (J), dissipation (W, the paper's 2R)
    sides    (v, phi, dphi, ddphi, p) -> F1, F2: side forces on the axles, N
    grip     (v, phi, dphi, ddphi, p) -> the same over the loads on the axles: the friction needed
    linear   vdot is affine in v, so the steady cycle is one linear fixed point
    mirrored the mirror image of a motion is a motion: gaits at offsets phi0 and -phi0 are alike
    """

    effects: tuple[str, ...]
    parameters: tuple[str, ...]
    motion: ca.Function
    energy: ca.Function
    sides: ca.Function
    grip: ca.Function
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
    """The model with the effects that the robot lists, for robots that share its neutral values."""
    return derive(*model_key(robot))


def model_key(robot: Robot) -> tuple[tuple[str, ...], frozenset[str]]:
    """The effects that a robot lists, and which of their parameters are neutral."""
    neutral = (
        f"{use.name}.{q.name}"
        for use in robot.physics
        for q in CATALOGUE[use.name].parameters
        if use.values.get(q.name, q.neutral) == q.neutral
    )
    return tuple(use.name for use in robot.physics), frozenset(neutral)


def require_friction(robot: Robot) -> None:
    """Raise InputError for a robot that no gait brings to a steady speed."""
    if not dynamics_of(robot).dissipates(robot):
        raise InputError(
            "The robot has no friction: kappa (or k) is 0 on both platforms, and `physics` adds "
            "none. Without friction no gait settles to a steady speed. Give at least one platform "
            "a kappa above 0."
        )


def derive(effects: tuple[str, ...] = (), neutral: frozenset[str] = frozenset()) -> Dynamics:
    """Derive the model with those of the named effects that have a steady cycle; `neutral` as for
    `assembled`."""
    return _derived(tuple(name for name in effects if name in steady_effects()), neutral)


@lru_cache
def _derived(effects: tuple[str, ...], neutral: frozenset[str]) -> Dynamics:
    assembly = assembled(effects, neutral=neutral)
    robot, p = assembly.mechanism, assembly.p
    phi, u = robot.phi, robot.speeds
    kane = equations(robot)
    needed = ca.substitute(kane.needed, kane.udot[1:3], ca.SX.zeros(2))
    vdot, ddphi = kane.udot[0], kane.udot[3]

    # The axles do not slip: s1 = s2 = 0 from here on. Row v is linear in vdot.
    sides = ca.vertcat(*(u[SPEEDS.index(name)] for name in sorted(robot.constrained)))
    needed, kinetic, power, w, ahead, side = (
        ca.substitute(part, sides, ca.SX.zeros(sides.numel()))
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
    state = {"v": v, "phi": phi, "dphi": dphi, "p": p}
    moving = {"v": v, "phi": phi, "dphi": dphi, "ddphi": ddphi, "p": p}
    outputs = {"vdot": solved, "w": w, "side": side, "torque": needed[3]}
    motion = function("motion", moving, outputs)
    grips = {
        f"grip{k}": needed[k] / (2 * load) for k, load in wheel_loads(robot.parameters).items()
    }
    return Dynamics(
        effects=effects,
        parameters=assembly.parameters,
        motion=motion,
        energy=function("energy", state, {"kinetic": kinetic, "dissipation": -power}),
        sides=function("sides", moving, {"F1": needed[1], "F2": needed[2]}),
        grip=function("grip", moving, grips),
        linear=_is_affine(ca.Function("vdot", [*moving.values()], [solved])),
        mirrored=_is_mirrored(motion),
    )


def function(name: str, inputs: Mapping[str, ca.SX], outputs: Mapping[str, ca.SX]) -> ca.Function:
    """A function of named scalars, with the common parts of its outputs computed once."""
    tidy = ca.vertsplit(ca.cse(ca.vertcat(*outputs.values())))
    return ca.Function(name, [*inputs.values()], tidy, [*inputs], [*outputs])


def _is_affine(vdot: ca.Function) -> bool:
    """Whether vdot (v, phi, dphi, ddphi, p) is affine in v.

    Terms in v^2 cancel between the bodies, but only once sines and cosines are multiplied out,
    which CasADi does not do; so the second difference in v is evaluated at some states.
    """
    p = np.linspace(0.5, 1.5, vdot.numel_in(4))
    for phi, dphi, ddphi in ((0.3, 1.0, -2.0), (-1.1, 0.7, 3.0), (0.8, -2.0, 0.5)):
        low, middle, high = (float(vdot(v, phi, dphi, ddphi, p)) for v in (-1.0, 0.0, 1.0))
        if abs(low - 2 * middle + high) > 1e-9 * (abs(low) + abs(middle) + abs(high)):
            return False
    return True


def _is_mirrored(motion: ca.Function) -> bool:
    """Whether `Dynamics.motion` gives the mirrored state the mirrored rates."""
    p = np.linspace(0.5, 1.5, motion.numel_in(4))
    for v, phi, dphi, ddphi in ((0.7, 0.3, 1.0, -2.0), (-1.0, -0.9, 0.7, 3.0)):
        here, there = (
            np.array([float(out) for out in motion(v, sign * phi, sign * dphi, sign * ddphi, p)])
            for sign in (1, -1)
        )
        if not np.allclose(there, here * [1, -1, -1, -1], rtol=1e-9, atol=1e-9):
            return False
    return True
