"""One steady period over time."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from rr_opt.formatting import number
from rr_opt.model.problem import Limits
from rr_opt.motion.steady_cycle import SteadyCycle
from rr_opt.report.figures import style


def cycle(axes: Sequence[Axes], steady: SteadyCycle, limits: Limits) -> Sequence[Axes]:
    """Fill four axes, top to bottom: phi (rad), its rate (rad/s), v (m/s), torque (N m)."""
    t = steady.t
    against_limit(axes[0], t, steady.phi, limits.angle, "φ, rad")
    against_limit(axes[1], t, steady.gait.rate(t), limits.rate, "dφ/dt, rad/s")
    axes[2].plot(t, steady.v, color=style.INK)
    mean = float(steady.v[:-1].mean())
    axes[2].axhline(mean, color=style.colour_of(steady.speed), lw=1.3, ls=(0, (5, 2)))
    axes[2].set_ylabel("v, m/s")
    axes[2].margins(y=0.25)
    means = f"mean of v {mean:+.4f} m/s, of P along its path {steady.speed:+.4f} m/s"
    style.note(axes[2], means, color=style.colour_of(steady.speed))
    against_limit(axes[3], t, steady.torque, limits.torque, "τ, N m")
    axes[3].set_xlabel("time, s")
    for ax in axes:
        ax.set_xlim(t[0], t[-1])
    axes[0].figure.align_ylabels(list(axes))  # type: ignore[union-attr]
    return axes


def against_limit(ax: Axes, t: ArrayLike, values: ArrayLike, limit: float, label: str) -> Axes:
    """A quantity over time with its limit; a limit far away is only named."""
    values = np.asarray(values, float)
    ax.plot(t, values, color=style.FORWARD)
    ax.set_ylabel(label)
    peak, unit = float(np.abs(values).max()), label.rsplit(", ", maxsplit=1)[-1]
    if not math.isfinite(limit):
        ax.margins(y=0.25)
        return ax
    if peak < 0.4 * limit:
        ax.margins(y=0.3)
        style.note(ax, f"{100 * peak / limit:.0f} % of the limit, {number(limit)} {unit}")
        return ax
    for value in (limit, -limit):
        ax.axhline(value, color=style.LIMIT, lw=1.2, ls=(0, (4, 2)))
    ax.set_ylim(-1.35 * max(limit, peak), 1.35 * max(limit, peak))
    style.note(ax, f"limit {number(limit)} {unit}", y=0.985, color=style.LIMIT)
    ax.axhline(0, color=style.GREY, lw=0.5)
    return ax
