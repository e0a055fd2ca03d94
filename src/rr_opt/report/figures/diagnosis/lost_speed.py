"""What the best gait of the robot as believed promises, what it makes, and what is possible."""

from __future__ import annotations

from matplotlib.axes import Axes

from rr_opt.report.diagnosis.loss import Loss
from rr_opt.report.diagnosis.loss_words import gait_words, pace
from rr_opt.report.figures.diagnosis.look import FINAL, NOMINAL

_BAR = 0.45


def lost_speed(ax: Axes, one: Loss) -> Axes:
    """A bar each, mm/s, whichever way; over it its speed, and at its foot its gait."""
    bars = (
        ("what the model as believed promises", one.believed, one.promised, "none", NOMINAL),
        ("what the robot as found makes of that gait", one.believed, one.reached, NOMINAL, NOMINAL),
        ("what its own best gait makes", one.best, one.speed, FINAL, FINAL),
    )
    for row, (words, gait, speed, inside, edge) in enumerate(bars):
        ax.barh(row, 1e3 * abs(speed), _BAR, color=inside, edgecolor=edge, lw=1.4)
        over = row - _BAR / 2 - 0.06
        ax.text(0, over, f"{words}: {pace(speed)}", va="bottom", fontsize=9.5)
        ink = "white" if inside != "none" else edge
        ax.text(
            0.02, row, gait_words(gait), va="center", fontsize=9, color=ink,
            transform=ax.get_yaxis_transform(),
        )  # fmt: skip
    ax.set_ylim(len(bars) - 0.65, -0.75)
    ax.set_yticks([])
    ax.spines["left"].set_visible(False)
    ax.grid(visible=False, axis="y")
    ax.set_xlabel("mean speed, mm/s")
    return ax
