"""An axis of a study as a figure shows it: its label, and where its steps lie."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rr_opt.files.study.axes import Axis
from rr_opt.report.quantities import number
from rr_opt.report.study.unit import unit_of, value_text

Array = NDArray[np.float64]

_EVEN = 0.05
_WIDEST = 60
"""Letters of names that fit side by side under a figure."""


@dataclass(frozen=True)
class Shown:
    """steps in the unit that people think in, and how they are called; factor: how many of that
    unit are one SI unit; log: on a logarithmic scale.

    ordered: steps are numbers with a place on a scale. If one is none, or is infinite, they are
    named and stand one beside the other, at 1, 2, 3 ..: the finite ones by size, infinity last.
    """

    label: str
    unit: str
    steps: Array
    texts: tuple[str, ...]
    factor: float
    ordered: bool
    log: bool

    @property
    def order(self) -> list[int]:
        """The steps from the smallest to the largest."""
        return [int(step) for step in np.argsort(self.steps, kind="stable")]

    def scale(self, ax: Axes, which: str = "x") -> None:
        """Label the axis of a figure and set its scale."""
        getattr(ax, f"set_{which}label")(self.label)
        if self.log:
            getattr(ax, f"set_{which}scale")("log")
            _plain_ticks(ax, which, self.steps)
        if not self.ordered:
            slant = which == "x" and sum(map(len, self.texts)) > _WIDEST
            style = {"rotation": 30, "ha": "right", "rotation_mode": "anchor"} if slant else {}
            getattr(ax, f"set_{which}ticks")(self.steps, self.texts, **style)


def shown(axis: Axis) -> Shown:
    """How to show an axis; keys that are taken in step are shown by the first."""
    line = next((line for line in axis.lines if line.numbers is not None), axis.lines[0])
    unit, factor = unit_of(line.key)
    more = f" and {len(axis.lines) - 1} more" if len(axis.lines) > 1 else ""
    numbers = line.numbers
    if numbers is None or not np.isfinite(numbers).all():
        values = line.values if numbers is None else numbers
        texts = tuple(value_text(line.key, value, 3) for value in values)
        rank = np.arange(len(texts)) if numbers is None else np.argsort(np.argsort(numbers))
        places = np.asarray(1 + rank, float)
        return Shown(f"{line.key.name}{more}", "", places, texts, 1.0, False, False)
    steps = factor * np.array(numbers)
    texts = tuple(value_text(line.key, value, 3) for value in numbers)
    label = f"{line.key.name}{more}" + (f", {unit}" if unit else "")
    return Shown(label, unit, steps, texts, factor, True, _even_in_log(steps))


def _even_in_log(steps: Array) -> bool:
    ordered = np.sort(steps)
    if len(ordered) < 3 or ordered[0] <= 0 or ordered[-1] < 2 * ordered[0]:
        return False
    ratios, gaps = np.diff(np.log(ordered)), np.diff(ordered)
    return bool(np.ptp(ratios) < _EVEN * ratios.mean() and np.ptp(gaps) > _EVEN * gaps.mean())


def _plain_ticks(ax: Axes, which: str, steps: Array) -> None:
    """Ticks at the steps themselves, at most six of them: powers of ten alone are too few."""
    ordered = np.sort(steps)
    chosen = ordered[np.unique(np.linspace(0, len(ordered) - 1, 6).round().astype(int))]
    getattr(ax, f"set_{which}ticks")(chosen, [number(step, 2) for step in chosen])
    getattr(ax, f"set_{which}ticks")([], minor=True)
