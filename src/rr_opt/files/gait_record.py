"""A gait as the mapping that a result holds, and such a mapping back to the gait.

`shape`, `amplitude`, `period` and `offset` are always there; a fourier gait adds `sines` and
`cosines`, a free gait `angle0`, `rate0` and `accelerations`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rr_opt.files.document import Document
from rr_opt.files.gait_model import FourierRecord, FreeRecord, SineRecord
from rr_opt.files.issue import Issue, shown, unknown_word
from rr_opt.files.model_issues import validate
from rr_opt.robot.fourier_gait import FourierGait
from rr_opt.robot.free_gait import FreeGait
from rr_opt.robot.gait import Gait, SineGait

_MODELS = {"sine": SineRecord, "fourier": FourierRecord, "free": FreeRecord}

_ROUNDING = 1e-6
"""What a record that was written by a program may be off by, relative to the gait's size."""


def gait_record(gait: Gait) -> dict[str, Any]:
    """The gait in SI, complete: `gait_from` makes the same gait of it, to the last digit."""
    record: dict[str, Any] = {
        "shape": gait.shape,
        "amplitude": gait.amplitude,
        "period": gait.period,
        "offset": gait.offset,
    }
    if isinstance(gait, FourierGait):
        record |= {"sines": list(gait.sines), "cosines": list(gait.cosines)}
    elif isinstance(gait, FreeGait):
        record |= {
            "angle0": gait.angle0,
            "rate0": gait.rate0,
            "accelerations": list(gait.accelerations),
        }
    return record


def gait_from(document: Document) -> tuple[Gait | None, list[Issue]]:
    """The gait that a mapping describes (None if there are issues), and all issues."""
    shape = document.data.get("shape", "sine")
    if not isinstance(shape, str):
        message = f"Read {shown(shape)}. Expected one of: {', '.join(_MODELS)}."
        return None, [document.issue("error", ("shape",), message)]
    if shape not in _MODELS:
        message = unknown_word(shape, list(_MODELS), "word")
        return None, [document.issue("error", ("shape",), message)]
    model, issues = validate(_MODELS[shape], document)
    if isinstance(model, SineRecord):
        return SineGait(model.amplitude, model.period, model.offset), issues
    if isinstance(model, FourierRecord):
        if len(model.sines) != len(model.cosines):
            message = (
                f"Read {len(model.cosines)} cosines and {len(model.sines)} sines. Expected as "
                "many of each. Write 0 for those that are missing."
            )
            return None, [document.issue("error", ("cosines",), message)]
        gait = FourierGait(model.period, model.offset, model.sines, model.cosines)
    elif isinstance(model, FreeRecord):
        gait = FreeGait(model.period, model.angle0, model.rate0, model.accelerations)
        issues = [document.issue("error", key, text) for key, text in _open_ends(gait)]
    else:
        return None, issues
    issues += [document.issue("error", key, text) for key, text in _disagreements(gait, model)]
    return (None if issues else gait), issues


def _open_ends(gait: FreeGait) -> Iterator[tuple[tuple[str, ...], str]]:
    """Where the values of a free gait do not come back to where they began."""
    ends = zip(("angle", "rate"), gait.nodes, ("rad", "rad/s"), strict=True)
    for what, values, unit in ends:
        gap = float(values[-1] - values[0])
        if not abs(gap) <= _ROUNDING * (1 + abs(values).max()):
            yield (
                ("accelerations",),
                f"After a period the {what} is {gap:.3g} {unit} from where it began. Expected it "
                "to come back, so that the gait can be repeated. Correct rate0 or accelerations.",
            )


def _disagreements(
    gait: FourierGait | FreeGait, model: FourierRecord | FreeRecord
) -> Iterator[tuple[tuple[str, ...], str]]:
    """Where what follows from the other values is given, and says something else."""
    if gait.amplitude == 0:
        yield (
            ("amplitude",),
            "Read a gait that does not move the servo. Expected one that does: its values make "
            "an amplitude of 0. Correct them.",
        )
    for key in ("amplitude", "offset"):
        given, made = getattr(model, key), getattr(gait, key)
        if given is not None and not abs(given - made) <= _ROUNDING * (1 + gait.peak_angle):
            yield (
                (key,),
                f"Read {given:.6g} rad. Expected {made:.6g} rad, which is what the gait's other "
                f"values make. Correct them, or delete {key}.",
            )
