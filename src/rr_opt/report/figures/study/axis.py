"""An axis of a study as a figure shows it: its label, and where its steps lie."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rr_opt.files.study.axes import Axis
from rr_opt.report.quantities import number, with_unit
from rr_opt.report.study.unit import unit_of

Array = NDArray[np.float64]

_EVEN = 0.05


@dataclass(frozen=True)
class Shown:
    """steps in the unit that people think in (1, 2, 3 .. for what is not a number), and how they
    are called; factor: how many of that unit are one SI unit; log: on a logarithmic scale."""

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
            getattr(ax, f"set_{which}ticks")(self.steps, self.texts)


def shown(axis: Axis) -> Shown:
    """How to show an axis; keys that are taken in step are shown by the first."""
    line = next((line for line in axis.lines if line.numbers is not None), axis.lines[0])
    unit, factor = unit_of(line.key)
    more = f" and {len(axis.lines) - 1} more" if len(axis.lines) > 1 else ""
    numbers = line.numbers
    if numbers is None or not np.isfinite(numbers).all():
        texts = tuple(str(value) for value in line.values)
        steps = np.arange(1.0, len(texts) + 1)
        return Shown(f"{line.key.name}{more}", "", steps, texts, 1.0, numbers is not None, False)
    steps = factor * np.array(numbers)
    texts = tuple(with_unit(step, unit, 3) for step in steps)
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
