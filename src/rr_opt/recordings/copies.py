"""Whether two recordings are of the same motion: a copy is no further evidence."""

from collections.abc import Iterable, Sequence

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import CHANNELS, Recording
from rr_opt.model.machine import MachineRun
from rr_opt.recordings.noise import spread_at

_ALIKE = 0.2
"""Rows are the same if their values agree to this fraction of their noise."""
_SHARE = 0.5
"""Share of rows in common that makes a copy: with independent noise there are next to none."""
_EXACT = 1e-6
"""SI; noise assumed for a signal without any."""

Rows = tuple[set[bytes], ...]
"""What a copy shares with its original, in one or several representations."""


def rows_of(recording: Recording) -> Rows:
    """The rows; and, however a copy was moved or turned, phi with the step to the next row, seen
    from the robot.

    No steps if a cell is wider than the noise: all steady motions would share them.
    """
    y, sigma = recording.data, recording.sigma
    rows = _cells((y(name), sigma[name]) for name in CHANNELS)
    place = ("x", "y", "psi")
    if any(spread_at(y(one), 1) < _ALIKE * np.nanmedian(sigma[one]) for one in place):
        return rows, set()
    step = np.diff(y("x") + 1j * y("y")) * np.exp(-1j * y("psi")[:-1])
    seen = (step.real, step.imag, np.diff(y("psi")), y("phi")[:-1])
    return rows, _cells((one, sigma[name][:-1]) for one, name in zip(seen, CHANNELS, strict=True))


def machine_rows_of(run: MachineRun) -> Rows:
    """The rows of a machine's recording, in cells of its noise, exact inputs as they are; and all
    values as they are, since the noise estimated for an excerpt may differ."""
    signals = {**run.inputs, **run.outputs}
    rows = _cells((y, run.sigma[name] or _EXACT) for name, y in signals.items())
    return rows, _cells((y, _EXACT) for y in signals.values())


def copied(rows: Rows, others: Iterable[tuple[str, Rows]]) -> str | None:
    """The name of the first of the others that is the same motion."""
    return next((name for name, other in others if _same(rows, other)), None)


def _cells(columns: Iterable[tuple[Array, Array | float]]) -> set[bytes]:
    """The cells, _ALIKE times the noise wide, that the rows of values fall into."""
    table = np.round(np.column_stack([y / (_ALIKE * sigma) for y, sigma in columns]))
    known = np.isfinite(table).all(axis=1)
    return {row.tobytes() for row in table[known] + 0.0}


def _same(one: Sequence[set[bytes]], two: Sequence[set[bytes]]) -> bool:
    return any(
        len(a & b) > _SHARE * max(min(len(a), len(b)), 1) for a, b in zip(one, two, strict=True)
    )
