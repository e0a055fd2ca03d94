"""Figures of a recording: the path, its channels, its command, its noise."""

import re
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from rr_opt.array import Array
from rr_opt.model.experiment import Flag, Recording
from rr_opt.model.gait import Gait
from rr_opt.model.machine import Machine, MachineRun
from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.gaps import Gap, bridged
from rr_opt.recordings.inspection import Inspection
from rr_opt.recordings.markers.pose import MarkerFit
from rr_opt.recordings.noise import NoiseEstimate
from rr_opt.results.figures import style

_MOST = 800
_DIGITS = re.compile(r"(\.\d\d)\d+")
_PLACES = re.compile(r'\b(?:d|x|y)="[^"]*"')


def thinned(t: Array, y: Array, most: int = _MOST) -> tuple[Array, Array]:
    """t and y (n,) reduced to some `most` points: the least and the largest of every piece.

    A piece with NaN keeps one, so that a gap remains a gap.
    """
    if len(y) <= most:
        return t, y
    kept: set[int] = set()
    for piece in np.array_split(np.arange(len(y)), most // 2):
        known, holes = piece[np.isfinite(y[piece])], piece[np.isnan(y[piece])]
        if len(known):
            kept |= {int(known[y[known].argmin()]), int(known[y[known].argmax()])}
        kept |= set(holes[:1].tolist())
    rows = sorted(kept)
    return t[rows], y[rows]


def small(svg: str) -> str:
    """The SVG text with coordinates rounded to a hundredth of a point, below screen resolution."""
    return _PLACES.sub(lambda found: _DIGITS.sub(r"\1", found.group()), svg)


_LABELS = {"x": "x, m", "y": "y, m", "psi": "ψ, rad", "phi": "φ, rad", "torque": "τ, N m"}
_MARKS = (
    (Flag.OUTLIER, "outlier", "x", style.BACKWARD),
    (Flag.OUT_OF_ORDER, "out of order", "+", style.LIMIT),
)
_MOST_GAPS = 200


def channels(axes: Sequence[Axes], recording: Recording, holes: Sequence[Gap]) -> None:
    """One axes for each channel; a shaded band is a gap, a cross a flagged sample.

    Short gaps are bridged by thin lines, in the drawing only.
    """
    t = recording.t
    for ax, channel in zip(axes, recording.channels, strict=True):
        y = recording.data(channel)
        if not np.isfinite(y).all():
            ax.plot(*thinned(t, bridged(t, y)), color=style.PLATFORM2, lw=0.8)
        ax.plot(*thinned(t, y), color=style.INK, lw=1.1)
        mine = [gap for gap in holes if channel in gap.channels or not gap.channels]
        for gap in sorted(mine, key=lambda one: -one.length)[:_MOST_GAPS]:
            ax.axvspan(gap.start, gap.end, color=style.PLATFORM2, alpha=0.25, lw=0)
        _flags(ax, recording, channel)
        ax.set(ylabel=_LABELS.get(channel, channel), xlim=(t[0], t[-1]))
        _limits(ax, y)
    axes[-1].set_xlabel("time, s")


def _flags(ax: Axes, recording: Recording, channel: str) -> None:
    for flag, words, mark, colour in _MARKS:
        rows = np.flatnonzero(recording.flags[channel] & flag)[:2000]
        if len(rows):
            ax.plot(recording.t[rows], recording.values[channel][rows], mark, color=colour, ms=5,
                    mew=1.2, label=words)  # fmt: skip
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="upper right", ncols=2)


def _limits(ax: Axes, y: np.ndarray) -> None:
    """The data fill the axes; an outlier far away is cut off."""
    known = y[np.isfinite(y)]
    if len(known) and np.ptp(known) > 0:
        room = 0.15 * float(np.ptp(known))
        ax.set_ylim(float(known.min()) - room, float(known.max()) + room)


_POINTS = 1000
_DOT = 2e-4
"""Half the length of a dot, in periods."""


def folded(ax: Axes, t: Array, phi: Array, gait: Gait, fit: ClockFit | None) -> None:
    """Every sample of phi, rad, against its phase in the period, over the command as a line."""
    known = np.flatnonzero(np.isfinite(phi))
    known = known[:: max(1, len(known) // _POINTS)]
    # One path of dashes as short as dots: markers would make the file several times larger.
    dash = gait.period * _DOT
    phase = t[known] % gait.period
    x = np.stack([phase - dash, phase + dash, np.full(len(known), np.nan)], 1).ravel()
    ax.plot(x, np.repeat(phi[known], 3), color=style.GREY, lw=2, solid_capstyle="round",
            label="recorded")  # fmt: skip
    phase = np.linspace(0, gait.period, 400)
    ax.plot(phase, gait.angle(phase), color=style.FORWARD, lw=1.6, label="command")
    if fit is not None:
        text = f"offset {1e3 * fit.offset:+.2f} ± {1.96e3 * fit.sigma[0]:.2g} ms"
        style.note(ax, f"{text}, scale {fit.scale:.4f}", x=0.015, y=0.06, ha="left", va="bottom")
    ax.set(xlim=(0, gait.period), xlabel="phase of the command, s", ylabel="φ, rad")
    ax.legend(loc="upper right", ncols=2)


def difference(ax: Axes, t: Array, phi: Array, gait: Gait) -> None:
    """phi less its command, mrad, over time."""
    ax.plot(*thinned(t, 1e3 * (phi - gait.angle(t))), color=style.INK, lw=0.7)
    ax.axhline(0, color=style.FORWARD, lw=1.2)
    ax.set(xlim=(t[0], t[-1]), xlabel="time, s", ylabel="φ − command, mrad")


def noise(ax: Axes, found: Mapping[str, NoiseEstimate], stated: Mapping[str, float]) -> None:
    """The estimate over the stated value, with its 95 % interval; 1 where nothing was stated.

    Beside it the noise at half the frequency, which is the same for white noise.
    """
    names = [name for name, one in found.items() if one.sigma > 0]
    for row, name in enumerate(names):
        one = found[name]
        base = stated[name] if stated[name] > 0 else one.sigma
        ax.errorbar(one.sigma / base, row, xerr=1.96 * one.error / base, fmt="o",
                    color=style.FORWARD, capsize=3,
                    label="" if row else "highest frequencies")  # fmt: skip
        ax.plot(one.slower / base, row + 0.22, "D", ms=5, color=style.BACKWARD,
                label="" if row else "half these frequencies")  # fmt: skip
    ax.axvline(1.0, color=style.INK, lw=1)
    style.lanes(ax, names)
    low, high = ax.get_xlim()
    if np.isfinite(high) and high > 20:
        ax.set_xscale("log")
    else:
        ax.set_xlim(min(low, 0.0), max(high, 1.5))
    ax.set_xlabel("noise relative to the stated noise")
    if names:
        ax.legend(loc="lower left", facecolor="white", labelcolor=style.GREY)


_ARROWS = 6


def path(ax: Axes, recording: Recording, gait: Gait | None) -> None:
    """P, m, and its mean over a period of the gait, where that is known: how the robot travels.

    A dot is the start; arrows are platform 1's heading, towards its axle.
    """
    x, y, psi = (recording.data(channel) for channel in ("x", "y", "psi"))
    step = max(1, len(x) // 4000)
    ax.plot(x[::step], y[::step], color=style.GREY, lw=0.8, alpha=0.7, label="P")
    if gait is not None:
        mean = [_mean_over(recording.t, part, gait.period) for part in (x, y)]
        ax.plot(*mean, color=style.FORWARD, lw=2.6, zorder=3, label="mean over a period")
    known = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    headed = known[np.isfinite(psi[known])]
    if len(known):
        ax.plot(x[known[0]], y[known[0]], "o", ms=8, color=style.OPTIMUM, mec=style.INK, zorder=5,
                label="start")  # fmt: skip
    rows = headed[np.linspace(0, len(headed) - 1, min(_ARROWS, len(headed))).astype(int)]
    ax.quiver(
        x[rows], y[rows], np.cos(psi[rows]), np.sin(psi[rows]),
        color=style.INK, width=0.005, scale=12, zorder=4,
    )  # fmt: skip
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=3)
    ax.margins(0.1)
    ax.set(aspect="equal", adjustable="datalim", xlabel="x, m", ylabel="y, m")


def _mean_over(t: Array, values: Array, period: float) -> Array:
    """The mean (n,) over a period around each of evenly spaced samples; NaN near ends and gaps."""
    size = max(1, round(period * (len(t) - 1) / (t[-1] - t[0])))
    mean = np.full(len(values), np.nan)
    if len(values) > size:
        half = size // 2
        whole = np.convolve(values, np.full(size, 1 / size), "valid")
        mean[half : half + len(whole)] = whole
    return mean


_CUT = 8.0
"""Axis limit, in units of the noise, if anything lies beyond."""


def over_time(ax: Axes, fit: MarkerFit) -> None:
    """Root mean square residual of each frame, mm; corrected and rejected frames marked below."""
    t = fit.recording.t
    ax.plot(*thinned(t, 1e3 * fit.residual), color=style.INK, lw=0.7)
    swapped = np.unique(np.concatenate([[], *(swap.frames for swap in fit.swaps)])).astype(int)
    ghosts = np.flatnonzero(fit.ghosts.out.any(axis=1))
    marked = (
        (swapped, "labels corrected", style.FORWARD, 0.02),
        (ghosts, "marker left out", style.BACKWARD, 0.05),
        (fit.ghosts.lost, "does not fit", style.LIMIT, 0.08),
    )
    for rows, words, colour, height in marked:
        if len(rows):
            ax.plot(t[rows], np.full(len(rows), height), "|", color=colour, ms=6, label=words,
                    transform=ax.get_xaxis_transform())  # fmt: skip
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="upper right", ncols=3)
    if np.isfinite(fit.noise) and fit.noise > 0:
        largest = float(np.nanmax(fit.residual))
        ax.set_ylim(0, 1e3 * min(1.1 * largest, _CUT * fit.noise))
    ax.set(xlim=(t[0], t[-1]), xlabel="time, s", ylabel="residual, mm")


def by_marker(ax: Axes, fit: MarkerFit) -> None:
    """Root mean square residual of each marker, mm."""
    colours = [(style.PLATFORM1, style.PLATFORM2)[where] for where in fit.bodies.platform]
    rows = np.arange(len(fit.whose))
    ax.barh(rows, 1e3 * np.nan_to_num(fit.whose), color=colours, height=0.6)
    style.lanes(ax, fit.bodies.labels)
    ax.set_xlabel("residual, mm")


def draw(found: Inspection) -> dict[str, str]:
    """SVG texts by name: `path`, `channels`, `noise`, and, if available, `command` and `rigid`."""
    recording, gait, markers = found.recording, found.gait, found.markers
    stated = {name: float(np.median(recording.sigma[name])) for name in recording.channels}
    count = len(recording.channels)
    over = style.figure(style.WIDTH, 1.4 * count + 0.5)
    axes = np.ravel(over.subplots(count, 1, sharex=True))
    channels(list(axes), recording, found.cleaned.gaps)
    over.align_ylabels()
    drawn = {
        "path": style.panel(4.4, lambda ax: path(ax, recording, gait)),
        "channels": style.svg(over),
        "noise": style.panel(3.2, lambda ax: noise(ax, found.cleaned.noise, stated)),
    }
    if gait is not None:
        one = style.figure(style.WIDTH, 5.0)
        above, below = one.subplots(2, 1, height_ratios=[1.4, 1])
        folded(above, recording.t, recording.data("phi"), gait, found.command)
        difference(below, recording.t, recording.data("phi"), gait)
        drawn["command"] = style.svg(one)
    if markers is not None:
        one = style.figure(style.WIDTH, 4.8)
        above, below = one.subplots(2, 1)
        over_time(above, markers)
        by_marker(below, markers)
        drawn["rigid"] = style.svg(one)
    return {name: small(text) for name, text in drawn.items()}


def draw_machine(one: tuple[Machine, MachineRun]) -> dict[str, str]:
    """SVG text by name."""
    machine, run = one
    data = {**run.inputs, **run.outputs}
    shown = [c for c in machine.channels if c.name in data]
    made = style.figure(height=0.6 + 1.2 * len(shown))
    axes = np.atleast_1d(made.subplots(len(shown), 1, sharex=True))
    for ax, c in zip(axes, shown, strict=True):
        ax.plot(*thinned(run.t, data[c.name]), color=style.INK, lw=1.1)
        ax.set(ylabel=f"{c.name}, {c.unit}", xlim=(run.t[0], run.t[-1]))
        _limits(ax, data[c.name])
    axes[-1].set_xlabel("time, s")
    return {"channels": small(style.svg(made))}
