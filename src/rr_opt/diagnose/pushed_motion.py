"""The motion of a Roller Racer with pushes: what else drives it beside its servo."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import casadi as ca

from rr_opt.diagnose.racer_system import stiff_states
from rr_opt.diagnose.shoot import System
from rr_opt.physics.assembly import Assembly, assembled
from rr_opt.physics.floor_motion import FloorMotion, solved
from rr_opt.physics.kane import equations
from rr_opt.physics.kinematics import Force, Frame, Mechanism

PUSHES = ("wheel1l", "wheel1r", "wheel2l", "wheel2r", "side1", "side2", "angle")
"""Rolling force at each wheel (N), side speed of each axle (m/s), error of the angle (rad)."""

DRIVES = (*PUSHES[:6], "side1dot", "side2dot", "angle", "angledot")
"""What drives the motion beside the servo, a side speed and an angle with their rates of change."""

FURTHER = 8
"""So many of them are none of the servo's own."""

_SIDES = slice(4, 6)


@lru_cache
def pushed_motion(effects: tuple[str, ...]) -> tuple[System, FloorMotion]:
    """The motion with the pushes as further drives."""
    plain = assembled(effects, sharp=True)
    push = ca.SX.sym("push", FURTHER)
    motion = solved(
        Assembly(
            plain.effects,
            _pushed(plain.mechanism, push),
            plain.seen,
            (*plain.parameters, *DRIVES[:FURTHER]),
            ca.vertcat(plain.p, push),
        )
    )
    rows = motion.rates.size1_in(1)
    state, p = ca.SX.sym("state", motion.size), ca.SX.sym("p", plain.p.numel())
    drive = ca.SX.sym("drive", rows + FURTHER)
    inputs = [state, drive[:rows], ca.vertcat(p, drive[rows:])]
    rates, seen = (
        ca.Function(f.name(), [state, drive, p], [f(*inputs)]) for f in (motion.rates, motion.seen)
    )
    return System(rates, seen, stiff_states(motion)), motion


def _pushed(robot: Mechanism, push: ca.SX) -> Mechanism:
    pushes = [
        Force(wheel.platform, wheel.point, push[k] * wheel.direction)
        for k, wheel in enumerate(robot.wheels)
    ]
    sides = robot.speeds[1:3]
    moved = sides + push[_SIDES]

    def slid(part: ca.SX) -> ca.SX:
        return ca.substitute(part, sides, moved)

    # What it takes to speed up sideways is felt along axle 1, which v moves at one to one.
    kane = equations(robot)
    felt = ca.jacobian(kane.needed[0], kane.udot[1:3]) @ push[6:8]
    first = robot.wheels[0]
    pushes.append(Force(1, ca.SX.zeros(2), -felt * first.direction))
    return replace(
        robot,
        frames={i: Frame(slid(f.origin), slid(f.rate)) for i, f in robot.frames.items()},
        rotors=tuple(replace(rotor, rate=slid(rotor.rate)) for rotor in robot.rotors),
        forces=(*(replace(f, vector=slid(f.vector)) for f in robot.forces), *pushes),
    )
