"""Where the fault sits, from the tests of the stages and from what was named.

An effect that was named explains the whole motion, recordings that it never saw too; the test of a
stage sees that stage alone. So the stage in which the effect acts is lit, and where the tests point
elsewhere the answer says so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from rr_opt.diagnose.diagnosis import Diagnosis, Finding, Misfit, Stage
from rr_opt.diagnose.model import Candidate
from rr_opt.diagnose.stages.balance import SIDES
from rr_opt.diagnose.stages.found import SEEN

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
