"""Where the fault sits, from the tests of the stages and from what was named.

An effect that was named explains the whole motion, recordings that it never saw too; the test of a
stage sees that stage alone. So the stage in which the effect acts is lit, and where the tests point
elsewhere the answer says so.

The way from the recording to the motion, tested stage by stage; the first fault is the guilty.

Upstream first: the tracked point and the clock; the angle against its command; the side speed of
each axle, with any speed and the measured angle; the balance of forces, with the measured angle;
and what in it depends on place or heading.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.stages.found import (
    FALSE_ALARM,
    FLOOR,
    MODEL_ERROR,
    SEEN,
    actuation,
    axle,
    blame,
    force,
    measurement,
    shift_of,
    size_of,
    units,
)
from rr_opt.machines.racer.stages.gram import Gram, Known, held, values_of
from rr_opt.machines.racer.stages.reference import (
    SHAPES,
    Path,
    Reference,
    deviates,
    path,
    reference,
)
from rr_opt.machines.racer.stages.tests import (
    SIDES,
    Servo,
    Variable,
    balance_gram,
    kinematic_gram,
    servo_test,
    shift_gram,
    side_forces,
    variables,
)
from rr_opt.sysid.diagnosis import Diagnosis, Finding, Misfit, Stage
from rr_opt.sysid.least_squares import Fit
from rr_opt.sysid.model import Candidate, Piece

_AXLES = ("constraint_axle1", "constraint_axle2")
_TURNING = frozenset(name.split(".")[0] for name in SIDES)
"""Effects that resist rolling, but not alike on both sides: what shows is that they turn."""

_TOLD_APART = 1.2
"""The worst recording is named where it is so much worse than the best."""


def located(
    said: Diagnosis, tested: Sequence[Stage], catalogue: Mapping[str, Candidate]
) -> Diagnosis:
    """The answer with `channel`, `where` and `stages`.

    tested  as `stages` returns them; none where they cannot be tested
    """
    if said.verdict in ("consistent", "parameters"):
        return _answered(said, tested, (), _nowhere(tested))
    if said.verdict == "unexplained":
        lit = tuple(stage.channel for stage in tested if stage.guilty)
        return _answered(said, tested, lit, _unnamed(tested))
    acting = tuple(_channel(one, tested, catalogue) for one in said.findings)
    return _answered(said, tested, acting, _named(tested, acting))


def _answered(
    said: Diagnosis, tested: Sequence[Stage], lit: tuple[str, ...], sentences: list[str]
) -> Diagnosis:
    places = {_place(channel): channel for channel in reversed(lit)}
    shown = tuple(
        replace(
            stage,
            guilty=_place(stage.channel) in places,
            channel=places.get(_place(stage.channel), stage.channel),
        )
        for stage in tested
    )
    told = [*sentences, *(_recordings(said.refitted) if lit else [])]
    return replace(said, channel=lit[0] if lit else "none", where=" ".join(told), stages=shown)


def _channel(found: Finding, tested: Sequence[Stage], catalogue: Mapping[str, Candidate]) -> str:
    """The channel in which an effect acts; of two axles the one that shows it."""
    own = catalogue[found.name].channel
    if found.name in _TURNING:
        return "yaw"
    if own not in _AXLES:
        return own
    sure = {
        f"constraint_axle{name[-1]}": abs(one.value) / max(one.high - one.low, 1e-300)
        for name, one in found.parameters.items()
        if name[-1] in "12"
    }
    if sure:
        return max(sure, key=lambda channel: sure[channel])
    seen = [stage for stage in tested if stage.channel in _AXLES]
    best = max(seen, key=lambda stage: (stage.guilty, stage.statistic), default=None)
    return best.channel if best else own


def _named(tested: Sequence[Stage], acting: tuple[str, ...]) -> list[str]:
    if not tested:
        return []
    places = [_place(channel) for channel in acting]
    told = [
        f"{_called(stage)}: {stage.where}"
        for stage in sorted(
            (one for one in tested if _place(one.channel) in places),
            key=lambda one: places.index(_place(one.channel)),
        )
        if stage.p_value < SEEN
    ]
    pointed = [one for one in tested if one.guilty]
    if not pointed:
        told.append("The tests of the stages, each on its own, see no fault that counts.")
    elif not any(_place(one.channel) in places for one in pointed):
        told.append(
            f"The tests of the stages on their own point elsewhere: at {_lower(pointed[0])}. "
            "What was named explains the whole motion, which weighs more."
        )
    return told


def _unnamed(tested: Sequence[Stage]) -> list[str]:
    if not tested:
        return []
    lit = [f"{_called(stage)}: {stage.where}" for stage in tested if stage.guilty]
    return lit or ["No stage on its own has a fault that counts."]


def _nowhere(tested: Sequence[Stage]) -> list[str]:
    return [
        f"No stage is lit, as the model accounts for the recordings. On its own the test of "
        f"{_lower(stage)} sees {stage.size:.2f} sigma."
        for stage in tested
        if stage.guilty
    ]


def _recordings(misfits: Sequence[Misfit]) -> list[str]:
    """Which recording shows it most, and which least."""
    rows = sorted(misfits, key=lambda one: one.rms)
    if len(rows) < 2 or rows[-1].rms < _TOLD_APART * rows[0].rms:
        return []
    worst, best = rows[-1], rows[0]
    return [
        f"Without what is missing, {worst.recording} is predicted worst ({worst.rms:.1f} sigma) "
        f"and {best.recording} best ({best.rms:.1f} sigma)."
    ]


def _place(channel: str) -> str:
    """Masses beside the axis and moments share a stage."""
    return "yaw" if channel == "mass" else channel


def _called(stage: Stage) -> str:
    return stage.name[0].upper() + stage.name[1:]


def _lower(stage: Stage) -> str:
    return f"'{stage.name}'"


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
