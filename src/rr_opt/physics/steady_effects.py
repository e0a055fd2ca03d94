"""Which effects have a place in a gait's steady cycle.

There the axles are held, every place and heading is like any other, and the angle is the one that
the servo makes. What the servo makes of its command, what the floor does here and not there, and
what a capture system sees of it all have no place in it.
"""

from __future__ import annotations

from functools import lru_cache

import casadi as ca

from rr_opt.physics.assembly import assembled
from rr_opt.physics.effects import CATALOGUE, Port
from rr_opt.robot.parameters import Robot


@lru_cache
def steady_effects() -> frozenset[str]:
    """Those that have one."""
    return frozenset(name for name, effect in CATALOGUE.items() if effect.enter and _same(name))


def passed_over(robot: Robot, port: Port | None = None) -> tuple[str, ...]:
    """The robot's effects, of one port or all, that a steady cycle passes over."""
    names = [use.name for use in robot.physics if use.name not in steady_effects()]
    return tuple(name for name in names if port in (None, CATALOGUE[name].port))


def _same(name: str) -> bool:
    """Whether the axles stay held and no force depends on place or heading."""
    robot = assembled((name,)).mechanism
    placed = any(ca.depends_on(force.vector, robot.pose) for force in robot.forces)
    return len(robot.held) == 2 and not placed
