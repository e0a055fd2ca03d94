"""What a person should know before trusting a recording, one sentence each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_UNITS = {
    "x": (1e3, "mm"),
    "y": (1e3, "mm"),
    "psi": (1e3, "mrad"),
    "phi": (1e3, "mrad"),
    "torque": (1e3, "mN m"),
}


def size_text(channel: str, size: float) -> str:
    """A size of a channel, from SI, to three digits: `1.2 mm`, `1230 mm`."""
    factor, unit = _UNITS.get(channel, (1.0, ""))
    return f"{float(f'{factor * size:.3g}'):g} {unit}".strip()


@dataclass(frozen=True)
class Doubt:
    """A doubt, and what was done about it.

    kind  a word for scripts, such as `swap` or `units`
    text  the sentences for people
    """

    kind: str
    text: str

    def __str__(self) -> str:
        return self.text


def texts(doubts: Iterable[Doubt]) -> tuple[str, ...]:
    """Their sentences."""
    return tuple(doubt.text for doubt in doubts)


def when(t: NDArray[np.float64], rows: Sequence[int] | NDArray[np.int_]) -> str:
    """`at t = 3.21 s`, or `between t = 3.21 s and 4.5 s`, of rows in order."""
    first, last = float(t[rows[0]]), float(t[rows[-1]])
    if len(rows) == 1:
        return f"at t = {first:.6g} s"
    return f"between t = {first:.6g} s and {last:.6g} s"


def frames_text(count: int) -> str:
    """`1 frame`, `312 frames`."""
    return f"{count} frame" + ("" if count == 1 else "s")
