"""The way from the recording to the motion, tested stage by stage; the first fault is the guilty.

Upstream first: the tracked point and the clock; the angle against its command; the side speed of
each axle, with any speed and the measured angle; the balance of forces, with the measured angle;
and what in it depends on place or heading.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from rr_opt.diagnose.diagnosis import Stage
from rr_opt.diagnose.fit import Fit
from rr_opt.diagnose.model import Piece
from rr_opt.diagnose.racer import RollerRacer
from rr_opt.diagnose.stages.actuation import Servo, servo_test
from rr_opt.diagnose.stages.angle import deviates
from rr_opt.diagnose.stages.balance import balance_gram
from rr_opt.diagnose.stages.blame import FALSE_ALARM, FLOOR, MODEL_ERROR, blame
from rr_opt.diagnose.stages.depends import Variable, variables
from rr_opt.diagnose.stages.found import (
    actuation,
    axle,
    force,
    measurement,
    shift_of,
    size_of,
    units,
)
from rr_opt.diagnose.stages.gram import Gram
from rr_opt.diagnose.stages.kinematics import kinematic_gram, shift_gram, side_forces
from rr_opt.diagnose.stages.known import Known, held, values_of
from rr_opt.diagnose.stages.path import Path, path
from rr_opt.diagnose.stages.ports import SHAPES
from rr_opt.diagnose.stages.reference import Reference, reference

_TESTS = 5
"""The clock, the servo, the kinematics, the balance; and the tracked point in its own right."""

_ROUNDS = 2
_NEAR = 0.1
"""Values that would move by less, in what was known of them, are where they belong."""

_KINEMATIC = ("point", "axle1", "axle2")
_BALANCE = ("rolling", "yaw", "floor")


def stages(model: RollerRacer, base: Fit) -> tuple[Stage, ...]:
    """Test the stages on the runs that were fitted.

    base  the parameters' fit over whole runs, without effects
    Returns none for a robot that already has effects which do not vanish smoothly, as their motion
    is not the one that is linear here, and where the fit left the numbers.
    """
    has = {use.name for use in model.experiment.robot.physics}
    if not has <= set(SHAPES) or not np.isfinite(base.cost):
        return ()
    given = model.nominal | dict(base.values)
    paths = _paths(model, base)
    refs = [reference(along, values_of(given)) for along in paths]
    known = Known(model.parameters, given, held(base.cost, base.count))
    over = variables(refs)
    servo = servo_test(model, refs)
    lengths = known.only(("c1", "c2"))
    motion = _settled(paths, refs, lengths, kinematic_gram, _KINEMATIC, over)
    forces = _settled(paths, refs, known, balance_gram, _BALANCE, over)
    limit = FALSE_ALARM / _TESTS
    clock, drive = _servo_faults(servo, limit)
    whole = np.sqrt(max(base.cost / max(base.count, 1) - 1.0, 0.0))
    shift = shift_gram(refs, side_forces(refs))
    sides = shift_of(motion, shift, _KINEMATIC)
    kinematic = blame(motion, _KINEMATIC, limit, wrong=sides > max(FLOOR, MODEL_ERROR * whole))
    pushed = size_of(forces.together(_BALANCE), forces.count)
    dynamic = blame(forces, _BALANCE, limit, wrong=pushed > FLOOR)
    tracked = "measurement" if kinematic.guilty == "point" else kinematic.guilty
    suspects = {"measurement"} if clock else set[str]()
    suspects |= {"actuation"} if drive else set[str]()
    suspects |= {tracked, dynamic.guilty} - {""}
    order = ("measurement", "actuation", "axle1", "axle2", *_BALANCE)
    guilty = min(suspects, key=order.index, default="")
    by_speed, by_force = units(refs)
    found = [
        measurement(servo, motion, kinematic, shift, over, by_speed, clock=clock, unsure=drive),
        actuation(servo),
        *(axle(i, motion, kinematic, shift, over, by_speed) for i in (1, 2)),
        *(force(name, forces, dynamic, over, by_force) for name in _BALANCE),
    ]
    return tuple(
        Stage(s.name, s.channel, s.statistic, s.p_value, s.size, key == guilty, s.where, s.curves)
        for key, s in zip(order, found, strict=True)
    )


def _paths(model: RollerRacer, base: Fit) -> list[Path]:
    """The paths of the fitted runs."""
    first = {piece.run: start for piece, start in base.starts.items() if piece.first == 0}
    follow = deviates(model, sorted(first))
    out = []
    for run, start in sorted(first.items()):
        piece = Piece(run, 0, len(model.runs[run].t))
        predicted = model.respond(piece, base.values, (), start).predicted
        out.append(path(model, run, predicted, follow=follow))
    return out


def _settled(
    paths: list[Path],
    refs: list[Reference],
    known: Known,
    gram: Callable[[Sequence[Reference], Known, Sequence[Variable]], Gram],
    names: tuple[str, ...],
    over: Sequence[Variable],
) -> Gram:
    """Where something is wrong, linearised again at the values that all faults leave to parameters.

    A fit without the fault bends the parameters to imitate it, and they may be far off.
    """
    for _ in range(_ROUNDS):
        found = gram(refs, known, ())
        if size_of(found.together(names), found.count) <= FLOOR:
            break
        d = found.fitted(found.always, names)[0]
        if np.abs(d).max() < _NEAR:
            break
        known = known.moved(d)
        refs = [reference(along, values_of(known.given)) for along in paths]
    return gram(refs, known, over)


def _servo_faults(servo: Servo, limit: float) -> tuple[bool, bool]:
    """Whether the clock is at fault, and whether the servo is: a clock explains all or nothing."""
    left = servo.servo.p < limit
    if servo.clock.p < limit and size_of(servo.clock, servo.count) > FLOOR:
        return not left, left
    return False, left and size_of(servo.servo, servo.count) > FLOOR
