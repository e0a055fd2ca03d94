"""The page's tables of the recordings: their misfit, and how they were made."""

from __future__ import annotations

import numpy as np

from rr_opt.diagnose.diagnosis import Misfit
from rr_opt.experiment.experiment import Run
from rr_opt.report.diagnosis.diagnosed import Diagnosed
from rr_opt.report.html import Badge, Cell, table
from rr_opt.report.quantities import number, with_unit


def misfit_table(one: Diagnosed) -> str:
    """Misfit of every recording and channel, before and after."""
    rows: list[list[Cell]] = []
    for before, after in zip(one.found.nominal, one.found.final, strict=True):
        use = Badge("held out", "fitted") if after.held_out else "fitted"
        rows.append(
            [
                after.recording,
                use,
                f"{before.rms:.2f} → {after.rms:.2f}",
                *(_channel(before, after, name) for name in _channels(one)),
            ]
        )
    return table(["Recording", "Use", "All, σ", *_channels(one)], rows)


def _channels(one: Diagnosed) -> list[str]:
    return list(dict.fromkeys(name for each in one.found.final for name in each.channels))


def _channel(before: Misfit, after: Misfit, name: str) -> str:
    if name not in before.channels or name not in after.channels:
        return "–"
    return f"{before.channels[name]:.2f} → {after.channels[name]:.2f}"


def recordings_table(one: Diagnosed) -> str:
    """What was recorded."""
    rows: list[list[Cell]] = [_recorded(run) for run in one.experiment.runs]
    head = ["Recording", "Use", "Start", "Amplitude", "Period", "Offset", "Length", "Data"]
    return table(head, rows)


def _recorded(run: Run) -> list[Cell]:
    recording, gait = run.recording, run.gait
    flags = np.array([recording.flags[name] > 0 for name in recording.channels])
    share = 100 * (1 - float(flags.mean()))
    return [
        run.name,
        run.use,
        run.start,
        with_unit(gait.amplitude, "rad", 3),
        with_unit(gait.period, "s", 3),
        with_unit(gait.offset, "rad", 3),
        f"{recording.t[-1] - recording.t[0]:.3g} s",
        f"{len(recording)} samples, {number(share, 3)} % good",
    ]
