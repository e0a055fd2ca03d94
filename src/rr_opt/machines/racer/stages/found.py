"""What each stage's tests say, as the answer tells it.

Which of several stages that share one equation is to blame.

Their columns overlap, so each is tested with the others fitted along. Where several could explain
all that is wrong, none of these tests sees anything. So of those that explain it alone the first is
taken that does so as well as the best; and only if none does, the first without which the others
are worse off.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.machines.racer.stages.gram import Gram, Worth
from rr_opt.machines.racer.stages.reference import Reference
from rr_opt.machines.racer.stages.tests import POINT, SLIP, Servo, Variable
from rr_opt.sysid.diagnosis import Curve, Stage

FALSE_ALARM = 0.01
"""Chance that any stage is called guilty where none is."""

FLOOR = 0.1
"""A fault of less is none, RMS in sigma."""

MODEL_ERROR = 0.05
"""So much of a fault's size may come from how it is described; less is not held against a stage."""

CLEAR = 25.0
"""Chi-square beyond noise by which one explanation is better than another."""

_LEAST = 0.25
"""A stage to blame is worth so much of the one that is worth most: half its size."""


@dataclass(frozen=True)
class Blame:
    """worth: of each stage with the others fitted along; guilty: the first to blame, if any.

    alone  what the guilty one is worth without the others
    """

    worth: Mapping[str, Worth]
    guilty: str
    alone: Worth


def blame(gram: Gram, names: Sequence[str], limit: float, *, wrong: bool) -> Blame:
    """Test each, upstream first.

    limit  the chance of noise alone below which a stage counts
    wrong  whether what all of them explain together is large enough to matter
    """
    every = gram.together(names)
    worth = {one: gram.worth(one, [n for n in names if n != one]) for one in names}
    alone = {one: gram.together((one,)) for one in names}
    if not wrong or every.p > limit:
        return Blame(worth, "", Worth(0.0, 0))
    # A stage may leave what is none, or what comes from how it is described, and explain all.
    described = MODEL_ERROR**2 * every.beyond
    enough = every.beyond - max(FLOOR**2 * gram.count, described)
    able = [one for one in names if alone[one].beyond >= enough and alone[one].p < limit]
    if able:
        best = max(alone[one].beyond for one in able) - max(CLEAR, described)
        first = next(one for one in able if alone[one].beyond >= best)
    else:
        most = max(w.beyond for w in worth.values())
        seen = [one for one in names if worth[one].p < limit and worth[one].beyond > _LEAST * most]
        first = seen[0] if seen else max(names, key=lambda one: alone[one].chi2)
    return Blame(worth, first, alone[first])


_DOUBTFUL = 1.5
"""What a fault should not depend on explains so much more of it than what it should."""

_NAMES = {
    "phase": "the phase",
    "speed": "the speed",
    "rate": "the commanded rate",
    "heading": "the heading",
    "along": "the place along x",
    "across": "the place along y",
    "time": "the time",
}

_SAYS = {
    "phase": "in the cycle, at phase {at:.2f}",
    "speed": "at {at:.2g} m/s",
    "rate": "where the command turns at {at:.2g} rad/s",
    "heading": "at a heading of {at:.0f} degrees",
    "along": "at x = {at:.2f} m",
    "across": "at y = {at:.2f} m",
    "time": "{at:.0f} s after the start",
}


def where(curves: Sequence[Curve], clear: Sequence[float], others: Mapping[str, float]) -> str:
    """A sentence on the curve that is clearest.

    clear   of each curve, by how much chi-square it beats what noise gives
    others  the same of variables on which the fault should not depend
    """
    if not curves or max(clear) < CLEAR:
        names = [_NAMES[one.variable] for one in curves]
        return f"It does not depend clearly on {_listed(names)}."
    k = int(np.argmax(clear))
    best = curves[k]
    peak = int(np.argmax(np.abs(best.mean) / best.error))
    at = float(best.at[peak]) * (180 / np.pi if best.variable == "heading" else 1.0)
    place = _SAYS[best.variable].format(at=at)
    told = f"It follows {_NAMES[best.variable]} best, and is clearest {place}."
    other = max(others, key=lambda name: others[name], default="")
    if other and others[other] > _DOUBTFUL * clear[k]:
        told += f" It follows {_NAMES[other]} better still, so another cause is possible."
    return told


def _listed(words: Sequence[str]) -> str:
    return " or ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def varies(curve: Curve) -> float:
    """Chi-square of a curve of independent bins against zero, less their number."""
    return float(np.sum((curve.mean / curve.error) ** 2) - curve.at.size)


SEEN = 0.01
"""At a larger chance of noise alone nothing is said of where a fault sits."""

_OWN = {
    "axle": ("phase", "speed", "time"),
    "rolling": ("speed", "time"),
    "yaw": ("phase", "speed"),
    "floor": ("heading", "along", "across"),
}
"""What a fault of each stage may depend on."""

_NOT = {"floor": ("phase", "speed")}
"""What it should not, but would where its columns stand in for another fault."""

_HARDLY = 30.0
"""A bin whose error is so many times that of the best has next to no data."""


def measurement(
    servo: Servo, motion: Gram, blamed: Blame, shift: Array, over: tuple[Variable, ...],
    unit: float, *, clock: bool, unsure: bool,
) -> Stage:  # fmt: skip
    """The tracked point and the clock; unsure: the servo hides what the clock is."""
    guilty = blamed.guilty == "point"
    point = blamed.alone if guilty else blamed.worth["point"]
    # Where the servo is at fault the clock cannot be told.
    chances = [point.p] if unsure else [point.p, servo.clock.p]
    p = 1 - (1 - min(chances)) ** len(chances)
    if clock:
        text = f"The recordings' clock is {1e3 * servo.offset:+.1f} ms against the command's."
        size = size_of(servo.clock, servo.count)
        return Stage("measurement", "measurement", servo.clock.chi2, p, size, False, text,
                     servo.curves)  # fmt: skip
    d = 1e3 * POINT * motion.fitted(("point",), () if guilty else ("axle1", "axle2"))[0]
    text = (
        f"The tracked point seems to be {d[0]:+.1f} mm along and {d[1]:+.1f} mm to the left of P."
    )
    size = _moved(motion, shift, "point", point, guilty=guilty)
    # What a point beside P would look like: as if axle 1 went sideways.
    curves, _ = _curves(motion, "axle1", over, unit, "axle")
    return Stage("measurement", "measurement", point.chi2, p, size, False, _told(point, text),
                 curves)  # fmt: skip


def actuation(servo: Servo) -> Stage:
    """The angle against its command."""
    size = size_of(servo.servo, servo.count)
    p = servo.servo.p
    clear = [varies(c) for c in servo.curves]
    text = _told(servo.servo, where(servo.curves, clear, {}))
    return Stage("actuation", "actuation", servo.servo.chi2, p, size, False, text, servo.curves)


def axle(
    i: int, motion: Gram, blamed: Blame, shift: Array, over: tuple[Variable, ...], unit: float
) -> Stage:
    """The side speed of axle i."""
    name = f"axle{i}"
    guilty = blamed.guilty == name
    alone = guilty and blamed.alone.p <= blamed.worth[name].p
    worth = blamed.alone if alone else blamed.worth[name]
    curves, text = _curves(motion, name, over, unit, "axle")
    size = _moved(motion, shift, name, worth, guilty=guilty)
    return Stage(f"side speed of axle {i}", f"constraint_axle{i}", worth.chi2, worth.p, size, False,
                 _told(worth, text), curves)  # fmt: skip


def force(name: str, forces: Gram, blamed: Blame, over: tuple[Variable, ...], unit: float) -> Stage:
    """The balance of forces: `rolling`, `yaw` or `floor`."""
    worth = blamed.alone if blamed.guilty == name else blamed.worth[name]
    curves, text = _curves(forces, "force", over, unit, name)
    channel = name
    if name == "yaw" and forces.together(("masses",)).chi2 > forces.together(("sides",)).chi2:
        channel = "mass"
    called = {"rolling": "rolling", "yaw": "yaw", "floor": "place and heading"}[name]
    return Stage(called, channel, worth.chi2, worth.p, size_of(worth, forces.count), False,
                 _told(worth, text), curves)  # fmt: skip


def units(refs: Sequence[Reference]) -> tuple[float, float]:
    """A side speed and a force, as curves have them, in sigma a second and in sigma a second^2."""
    sigma = float(np.nanmedian(refs[0].sigma[:, 0]))
    pushed = float(np.mean([np.mean(ref.ports["by_force1"]) for ref in refs]))
    return SLIP / sigma, pushed / sigma


def _told(worth: Worth, text: str) -> str:
    return text if worth.p < SEEN else "Nothing is seen here."


def _curves(
    gram: Gram, what: str, over: tuple[Variable, ...], unit: float, stage: str
) -> tuple[tuple[Curve, ...], str]:
    """A fault against each variable that it may depend on, and in words where it is clearest."""
    curves, clear = [], []
    for x in over:
        if x.name not in _OWN[stage]:
            continue
        block = f"{what} by {x.name}"
        mean, spread = gram.fitted((block,))
        error = np.sqrt(np.maximum(np.diag(spread), 0.0))
        some = error > 0
        if some.any():
            some &= error < _HARDLY * error[some].min()
            curves.append(Curve(x.name, x.unit, x.nodes[some], mean[some] * unit,
                                error[some] * unit))  # fmt: skip
            clear.append(gram.together((block,)).beyond)
    others = {
        x.name: gram.together((f"{what} by {x.name}",)).beyond
        for x in over
        if x.name in _NOT.get(stage, ())
    }
    return tuple(curves), where(curves, clear, others)


def size_of(worth: Worth, count: int) -> float:
    """RMS in sigma that goes with a chi-square."""
    return float(np.sqrt(worth.beyond / max(count, 1)))


def _moved(motion: Gram, shift: Array, name: str, worth: Worth, *, guilty: bool) -> float:
    """RMS in sigma: of the guilty stage how far it moves the robot, else what the test sees."""
    if guilty:
        return shift_of(motion, shift, (name,))
    return size_of(worth, motion.count)


def shift_of(gram: Gram, shift: Array, names: tuple[str, ...]) -> float:
    """How far the fitted side speeds move the robot, RMS in sigma, less what noise does."""
    theta, spread = gram.fitted(names)
    first = gram.blocks["point"].start
    k = [
        i - first for name in names for i in range(gram.blocks[name].start, gram.blocks[name].stop)
    ]
    E = shift[np.ix_(k, k)]
    square = theta @ E @ theta - np.trace(E @ spread)
    return float(np.sqrt(max(square, 0.0) / max(gram.count, 1)))
