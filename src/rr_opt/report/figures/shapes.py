"""Waveforms compared: angle, rate, and the speed that each one reaches."""

from __future__ import annotations

import numpy as np

from rr_opt.report.figures import style
from rr_opt.results.shapes import FastestShapes, family

_SAMPLES = 1500
_SHADES = (0.35, 0.55, 0.75, 1.0)


def draw(compared: FastestShapes) -> dict[str, str]:
    """The figure as SVG text by its name; nothing if no family has an optimum.

    phi (rad) and its rate (rad/s) over the phase, and a bar for each speed (mm/s).
    """
    solved = [(one, one.gait, one.speed) for one in compared.solved]
    lines = [(one, gait, speed) for one, gait, speed in solved if gait and speed is not None]
    if not lines:
        return {}
    with style.styled():
        drawn = style.figure(style.WIDTH, 6.4)
        axes = drawn.subplot_mosaic([["angle"], ["rate"], ["speed"]])
        angle, rate, bars = (axes[name] for name in ("angle", "rate", "speed"))
        phase, top = np.linspace(0, 1, _SAMPLES), max(1e3 * abs(speed) for *_, speed in lines)
        for place, (one, gait, speed) in enumerate(lines):
            first = place == 0
            colour = style.GREY if first else style.colour_of(speed)
            alpha = 1.0 if first else _SHADES[place - len(lines)]
            line = {"color": colour, "alpha": alpha, "ls": (0, (5, 2)) if first else "-"}
            angle.plot(phase, gait.angle(phase * gait.period), **line)
            rate.plot(phase, gait.rate(phase * gait.period), **line)
            size, gain = 1e3 * abs(speed), compared.gain(one) or 0.0
            text = f"{size:.0f} mm/s" + ("" if first else f"  {100 * gain:+.0f} %")
            bars.barh(place, size, height=0.62, color=colour, alpha=alpha)
            bars.text(size + 0.02 * top, place, text, va="center", color=style.INK)
        limit = compared.answers[0].problem.limits.rate
        for value in (limit, -limit) if np.isfinite(limit) else ():
            rate.axhline(value, color=style.LIMIT, lw=1.2, ls=style.DASHED)
        angle.set_ylabel("φ, rad")
        rate.set(ylabel="dφ/dt, rad/s", xlabel="share of the period")
        for ax in (angle, rate):
            ax.set_xlim(0, 1)
        style.lanes(bars, [family(one) for one, *_ in lines])
        bars.set(xlim=(0, 1.5 * top), xlabel="speed of the best gait, mm/s")
        return {"shapes": style.svg(drawn)}
