"""The mechanism with the effects of a robot in it, and the names and symbols of its parameters."""

from __future__ import annotations

from dataclasses import dataclass, replace

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.effects import CATALOGUE, Port
from rr_opt.physics.kinematics import ROBOT_PARAMETERS, Mechanism, mechanism, robot_values
from rr_opt.physics.seen import Seen
from rr_opt.robot.parameters import Robot

_ORDER = (Port.CONSTRAINT, Port.MASS, Port.FORCE, Port.ACTUATION, Port.MEASUREMENT)
"""What turns the axles comes first, also of those at its port, as every force depends on it."""
_LISTED = tuple(CATALOGUE)


@dataclass(frozen=True)
class Assembly:
    """A mechanism over symbols: `p` stacks those of `parameters`.

    effects     as they were asked for
    seen        what a capture system sees of it
    parameters  ROBOT_PARAMETERS, then `effect.parameter` of each effect that is in one of the two
    """

    effects: tuple[str, ...]
    mechanism: Mechanism
    seen: Seen
    parameters: tuple[str, ...]
    p: ca.SX


def assembled(effects: tuple[str, ...], *, sharp: bool = False) -> Assembly:
    """The paper's robot with those of the named effects that change it or how it is seen."""
    robot = replace(mechanism(), sharp=sharp)
    seen = Seen(robot.pose[0], robot.pose[1], robot.pose[2], robot.phi)
    symbols = {name: robot.parameters[name] for name in ROBOT_PARAMETERS}
    for name in sorted(
        effects, key=lambda name: (_ORDER.index(CATALOGUE[name].port), _LISTED.index(name))
    ):
        effect = CATALOGUE[name]
        values = {q.name: ca.SX.sym(f"{name}.{q.name}") for q in effect.parameters}
        if effect.enter:
            robot = effect.enter(robot, values)
        elif effect.observe:
            seen = effect.observe(seen, values)
        else:
            continue
        symbols |= {f"{name}.{parameter}": value for parameter, value in values.items()}
    return Assembly(effects, robot, seen, tuple(symbols), ca.vertcat(*symbols.values()))


def values_of(robot: Robot, parameters: tuple[str, ...]) -> NDArray[np.float64]:
    """The numbers behind an assembly's parameters for a robot that has its effects, SI.

    A parameter of an effect that the robot does not give is neutral.
    """
    own = dict(zip(ROBOT_PARAMETERS, robot_values(robot), strict=True))
    beyond = {
        f"{use.name}.{q.name}": use.values.get(q.name, q.neutral)
        for use in robot.physics
        for q in CATALOGUE[use.name].parameters
    }
    return np.array([(own | beyond)[name] for name in parameters])
