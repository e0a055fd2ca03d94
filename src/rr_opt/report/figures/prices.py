"""What each limit and bound costs: the speed gained if it gave way by one per cent."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes

from rr_opt.answers.quantities import QUANTITIES, number
from rr_opt.answers.speed import BoundRow, LimitRow
from rr_opt.report.figures.style import FORWARD, GREY, INK


@dataclass(frozen=True)
class Gain:
    """One line of the figure: mm/s gained by relaxing something by 1 %, and what it is."""

    label: str
    gain: float
    remark: str


def gains(limits: Iterable[LimitRow], bounds: Iterable[BoundRow]) -> list[Gain]:
    """The lines, the largest gain first; inactive limits follow with how much of them is used."""
    active: list[Gain] = []
    idle: list[Gain] = []
    for row in limits:
        if not math.isfinite(row.limit):
            continue
        if row.active:
            way = -1 if row.name == "singularity" else 1
            gain = 10 * way * row.shadow_price * row.limit
            active.append(Gain(f"limit: {row.name}", gain, ""))
        else:
            idle.append(Gain(f"limit: {row.name}", 0.0, _use(row)))
    for row in bounds:
        if row.active in ("low", "high") and row.shadow_price is not None:
            edge = row.low if row.active == "low" else row.high
            gain = 10 * row.shadow_price * abs(edge) * (-1 if row.active == "low" else 1)
            word = "least" if row.active == "low" else "largest"
            name = QUANTITIES[row.name].words.replace("inertia ratio ", "")
            active.append(Gain(f"{word} {name}", gain, ""))
    return sorted(active, key=lambda one: -one.gain) + idle


def _use(row: LimitRow) -> str:
    kind = QUANTITIES[row.name]
    unit, factor = kind.common
    if row.name == "singularity":
        least, value = number(row.limit * factor, 3), number(row.value * factor, 3)
        return f"not active: {value} {unit} kept, {least} asked"
    return f"not active: {100 * row.value / row.limit:.0f} % used"


def prices(ax: Axes, lines: Sequence[Gain]) -> Axes:
    """A lollipop a line, the first on top."""
    places = range(len(lines))
    reach = max([one.gain for one in lines] + [1e-9])
    for place, one in zip(places, lines, strict=True):
        ax.plot([0, one.gain], [place, place], color=FORWARD, lw=3, solid_capstyle="butt")
        idle = bool(one.remark)
        colour = GREY if idle else FORWARD
        ax.plot(one.gain, place, "o", ms=6 if idle else 9, color=colour, clip_on=False, zorder=4)
        text = one.remark or f"{one.gain:+.3g} mm/s"
        at = max(one.gain, 0.0) + 0.035 * reach
        ax.text(at, place, text, va="center", color=GREY if idle else INK, fontsize=9.5)
    ax.set_yticks(list(places), [one.label for one in lines])
    ax.set_ylim(len(lines) - 0.4, -0.6)
    ax.set_xlim(min(0.0, *(one.gain for one in lines)), 1.35 * reach)
    ax.grid(axis="y", visible=False)
    ax.spines["left"].set_visible(False)
    ax.tick_params(axis="y", length=0, pad=9)
    ax.set_xlabel("speed gained by relaxing it by 1 %, mm/s")
    return ax
