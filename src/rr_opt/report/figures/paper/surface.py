"""A surface of average speed as a map, with what lies beyond the servo's rate hatched."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from rr_opt.paper.printed import Row
from rr_opt.paper.surfaces import ANGLE_LIMIT, RATE_LIMIT, SpeedSurface
from rr_opt.report.figures.style import GREY, INK, LIMIT, PAPER, SIGNED
from rr_opt.report.quantities import number


def surface(ax: Axes, found: SpeedSurface, across: NDArray, singular: float) -> TwoSlopeNorm:
    """Filled contours over `across` (the ratio or the period) and amplitude.

    singular: the angle of the singular posture, rad. Returns what gives a speed its colour.
    """
    speed = 1e3 * found.speed
    top = max(float(abs(speed).max()), 1e-9)
    norm = TwoSlopeNorm(0.0, -top, top)
    fill = ax.contourf(across, found.amplitude, speed, levels=25, cmap=SIGNED, norm=norm, zorder=1)
    fill.set(edgecolor="face", linewidth=0.4)
    ax.contour(across, found.amplitude, speed, levels=[0.0], colors=[INK], linewidths=0.8, zorder=2)
    rate = found.rate
    if rate.max() > RATE_LIMIT:
        ax.contourf(
            across, found.amplitude, rate, levels=[RATE_LIMIT, 2 * rate.max()],
            colors=[(1, 1, 1, 0.35)], hatches=["////"], zorder=3,
        )  # fmt: skip
        ax.contour(
            across, found.amplitude, rate, levels=[RATE_LIMIT], colors=[LIMIT], linewidths=1.6,
            zorder=4,
        )  # fmt: skip
    bar = ax.figure.colorbar(fill, ax=ax, pad=0.02, aspect=30, ticks=MaxNLocator(7))
    bar.set_label("mean speed, mm/s  (− platform 2 leads)")
    bar.outline.set_visible(False)  # type: ignore[operator]
    ax.grid(False)
    ax.set_ylabel("amplitude α, rad")
    ax.set_title("Hatched: beyond 30 rpm")
    ax.annotate(
        f"{number(singular, 3)} rad, singular posture, and {number(ANGLE_LIMIT)} rad, the servo's "
        "limit, are above the plot", (0, -0.2), xycoords="axes fraction", fontsize=8.5, color=GREY,
    )  # fmt: skip
    return norm


def marked(
    ax: Axes, points: Sequence[tuple[float, float, Row]], norm: TwoSlopeNorm, *, stacked: bool
) -> None:
    """Measured means at their places, in the colour of their speed, with their intervals.

    The tables give no sign: they are shown with the model's. stacked: points stand above one
    another; else their numbers stand above and below them in turn.
    """
    for i, (x, y, row) in enumerate(points):
        above = stacked or i % 2 == 0
        colour = SIGNED(norm(-1e3 * row.mean))
        ax.plot(x, y, "o", ms=11, mfc=colour, mec=INK, mew=1.3, zorder=6, clip_on=False)
        text = f"{number(1e3 * row.mean, 3)} ± {number(1e3 * row.half_width, 3)}"
        halo = [withStroke(linewidth=3, foreground=PAPER, alpha=0.9)]
        ax.annotate(
            text, (x, y), (0, 9 if above else -17), textcoords="offset points",
            fontsize=8.5, zorder=7,
            ha="right" if x > 0.9 * ax.get_xlim()[1] else "center",
            path_effects=halo,
        )  # fmt: skip
