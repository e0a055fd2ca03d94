"""What has play: platform 2 on the motor's shaft, and the joint's pin in its hole.

A stop is a stiff spring with a damper that fades in over the first depth, so that its force neither
jumps at a touch nor ever pulls.
"""

from __future__ import annotations

import casadi as ca

from rr_opt.lab.planar.moment import Moment, Pull, spring
from rr_opt.lab.planar.motor import motor
from rr_opt.lab.rig import Rig

QUICK = 1000.0
"""1/s, how fast what hits a stop comes to rest in it: within some milliseconds."""

FIRST_ANGLE, FIRST_LENGTH = 1e-5, 1e-6
"""rad and m, the depth over which a stop's damper fades in; a hundredth of what noise lets see."""


def stops(moment: Moment, rig: Rig) -> list[Pull]:
    """All that the rig has."""
    return [*_play(moment, rig), *_pin(moment, rig)]


def _play(moment: Moment, rig: Rig) -> list[Pull]:
    """The platform runs freely on the shaft, half the play to either side."""
    if not rig.play:
        return []
    ahead = moment.layout.of("phi") - moment.layout.of("shaft")
    # As stiff as the motor, against which it is pressed.
    drive = motor(rig.robot)
    return [_stop(moment, ahead, rig.play / 2, drive.stiffness, drive.damping, FIRST_ANGLE)]


def _pin(moment: Moment, rig: Rig) -> list[Pull]:
    """A round pin in a round hole: free within, pushed back to the middle at the rim."""
    if not rig.pin:
        return []
    across = [moment.layout.of(name) for name in ("pin_ahead", "pin_left")]
    # The root has no slope in the middle, where nothing is pushed anyway.
    off = ca.sqrt(across[0] ** 2 + across[1] ** 2 + FIRST_LENGTH**2)
    one, two = rig.robot.platform1.m, rig.robot.platform2.m
    mass = one * two / (one + two)
    return [_stop(moment, off, rig.pin, mass * QUICK**2, 2 * mass * QUICK, FIRST_LENGTH)]


def _stop(
    moment: Moment, off: ca.SX, reach: float, stiffness: float, damping: float, first: float
) -> Pull:
    """Stops at `reach` to both sides of 0."""
    side = ca.sign(off)
    deep = ca.fmax(ca.fabs(off) - reach, 0)
    deepens = side * (moment.way(off) @ moment.w)
    damper = damping * deep / (deep + first)
    touches = ca.logic_and(deep > 0, stiffness * deep + damper * deepens > 0)
    return spring(moment, off, touches * stiffness, touches * damper, side * reach)
