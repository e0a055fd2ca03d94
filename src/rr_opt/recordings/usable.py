"""Which recordings of an experiment can be diagnosed together, and what stands in the way.

Nothing is put right: the experimenter has to say. A fault of the robot is no reason to refuse.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.model.experiment import CHANNELS, Experiment, Recording, Run
from rr_opt.outcome import InputError
from rr_opt.recordings.warnings import Notice, notice


@dataclass(frozen=True)
class Checked:
    """What speaks against diagnosing the recordings, in sentences.

    left_out  by name, of each recording that tells nothing
    wrong     what cannot be as the experiment says: units, signs, clocks, the gait; or that no
              recording is left to fit
    """

    left_out: dict[str, str]
    wrong: tuple[str, ...]


def checked(experiment: Experiment) -> Checked:
    """What the recordings were warned of when they were read, and how they go together."""
    left_out = dict(_left_out(experiment))
    wrong = [
        f"{run.name}: {one}" for run in experiment.runs for one in told(run) if one.level == "error"
    ]
    kept = [run for run in experiment.runs if run.name not in left_out]
    half = [any(one.code == "command.half" for one in told(run)) for run in kept]
    if not wrong and len(half) > 1 and all(half):
        wrong.append(notice("command.signs"))
    if not wrong and all(run.use != "fit" for run in experiment.runs):
        wrong.append(
            "All recordings are held out. Expected some to fit. Mark them with `use: fit`."
        )
    elif not wrong and all(run.use != "fit" for run in kept):
        wrong.append(
            "No recording to fit is left, so nothing can be told of this robot. Record some "
            "periods in which it drives."
        )
    return Checked(left_out, tuple(wrong))


def told(run: Run) -> list[Notice]:
    """What its recording was warned of when it was read."""
    return [one for one in run.recording.doubts if isinstance(one, Notice)]


def stops(doubt: str) -> bool:
    """Whether a recording with this doubt cannot be diagnosed."""
    return isinstance(doubt, Notice) and (doubt.level == "error" or doubt.kind == "useless")


def usable(experiment: Experiment) -> tuple[Experiment, tuple[str, ...]]:
    """The experiment without the recordings that tell nothing, and a sentence on each of those.

    Raises InputError for recordings that are not as the experiment says, and where no recording is
    left to fit.
    """
    found = checked(experiment)
    if found.wrong:
        raise InputError("\n".join((*found.left_out.values(), *found.wrong)))
    runs = tuple(run for run in experiment.runs if run.name not in found.left_out)
    return replace(experiment, runs=runs), tuple(found.left_out.values())


def _left_out(experiment: Experiment) -> Iterator[tuple[str, str]]:
    """Names, and why they tell nothing. What is to be fitted goes before what is held out."""
    seen: list[tuple[str, set[bytes]]] = []
    for run in sorted(experiment.runs, key=lambda one: one.use != "fit"):
        rows = _rows(run.recording)
        why = next((one for one in told(run) if one.kind == "useless"), None)
        copied = next((name for name, others in seen if _same(rows, others)), None)
        if why is None and copied is not None:
            why = notice("useless.copy", other=copied)
        if why is not None:
            yield run.name, f"{run.name}: {why} It is left out."
        seen.append((run.name, rows))


_ALIKE = 0.2
"""Rows are the same whose values are equal to this part of their noise."""
_SHARE = 0.5
"""Of its rows that another recording has too: independent noise makes next to none."""


def _rows(recording: Recording) -> set[bytes]:
    values = [recording.data(name) / (_ALIKE * recording.sigma[name]) for name in CHANNELS]
    table = np.round(np.column_stack(values))
    known = np.isfinite(table).all(axis=1)
    return {row.tobytes() for row in table[known] + 0.0}


def _same(one: set[bytes], two: set[bytes]) -> bool:
    return len(one & two) > _SHARE * max(min(len(one), len(two)), 1)
