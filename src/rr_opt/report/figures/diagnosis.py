"""Figures of a diagnosis: evidence, paths, what the simulation leaves, before and after."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.formatting import number
from rr_opt.model.experiment import CHANNELS as SEEN
from rr_opt.model.experiment import Recording
from rr_opt.report.diagnosis.loss import gait_words, loss_sentences, pace
from rr_opt.report.figures import style
from rr_opt.results.diagnosis import ExplainedExperiment
from rr_opt.results.loss import Loss
from rr_opt.sysid.diagnosis import Curve, Misfit, Residue, Stage

NOMINAL, FINAL, RECORDED = style.BACKWARD, style.FORWARD, "#b4bdc6"
"""The model as believed is orange, as found blue, what was recorded grey."""

NOISE = style.GREY
CHANNELS = {"x": "x", "y": "y", "psi": "ψ", "phi": "φ", "torque": "τ"}
_WIDE = 8.0
"""With more sigma than this a linear axis would hide the noise."""


def stretched(largest: float) -> bool:
    """Whether an axis in sigma needs a scale that is linear only near the noise."""
    return largest > _WIDE


_ENDS = (2.5, 97.5)
_Z = 1.96
_LINEAR = 4.0
"""Up to this many sigma a stretched axis is linear."""
_MARKS = (0, *(sign * 10**power for power in range(1, 7) for sign in (-1, 1)))


def bands(
    axes: Sequence[Axes], nominal: Sequence[Misfit], final: Sequence[Misfit], names: Sequence[str]
) -> None:
    """One axes a channel, the recordings one after the other: 95 % of the residuals, in sigma."""
    starts = np.concatenate([[0.0], np.cumsum([one.t[-1] - one.t[0] for one in final])])
    for k, (ax, name) in enumerate(zip(axes, names, strict=True)):
        largest = 0.0
        for level, colour in ((nominal, NOMINAL), (final, FINAL)):
            for start, one in zip(starts, level, strict=False):
                at, low, high = _band(one.t, one.residuals[:, k])
                here = at - one.t[0] + start
                ax.fill_between(here, low, high, color=colour, alpha=0.45, lw=0.8, step="mid")
                largest = max([largest, *np.abs([*low, *high])[np.isfinite([*low, *high])]])
        for end in (-_Z, _Z):
            ax.axhline(end, color=NOISE, lw=1, ls=(0, (4, 2)))
        for edge in starts[1:-1]:
            ax.axvline(edge, color=style.GREY, lw=0.8)
        if stretched(largest):
            ax.set_yscale("symlog", linthresh=_LINEAR, linscale=1)
            ax.yaxis.set_major_locator(FixedLocator(_MARKS))
            ax.yaxis.set_minor_locator(NullLocator())
            ax.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
        ax.set(ylabel=f"{CHANNELS.get(name, name)}, σ", xlim=(0, starts[-1]))
    for (first, last), one in zip(itertools.pairwise(starts), final, strict=True):
        axes[0].text((first + last) / 2, 1.03, one.recording.removesuffix(".csv"), ha="center",
                     va="bottom", fontsize=9, color=style.GREY,
                     transform=axes[0].get_xaxis_transform())  # fmt: skip
    axes[-1].set_xlabel("time, one recording after the other, s")


def _band(t: Array, residuals: Array) -> tuple[Array, Array, Array]:
    """Times of the bins, and the ends of 95 % of a bin's residuals; NaN without data."""
    pieces = np.array_split(np.arange(len(t)), max(round(t[-1] - t[0]), 1))
    rows = []
    for piece in pieces:
        inside = residuals[piece][np.isfinite(residuals[piece])]
        ends = np.percentile(inside, _ENDS) if len(inside) > 3 else (np.nan, np.nan)
        rows.append((t[piece].mean(), *ends))
    at, low, high = np.array(rows).T
    return at, low, high


_EVIDENCE_Z = 1.96
_NAMES = {
    "phase": "phase of the cycle",
    "rate": "commanded rate",
    "along": "place along x",
    "across": "place along y",
    "time": "time since the start",
}


def input_words(channel: str) -> str:
    """What an unknown input of a channel is, with its unit."""
    if channel == "actuation":
        return "angle, rad"
    return "side speed, m/s" if channel.startswith("constraint") else "force per wheel, N"


def curve(ax: Axes, one: Curve | Residue, label: str) -> Axes:
    """The mean in bins with its 95 % band; at zero there is no fault."""
    low, high = one.mean - _EVIDENCE_Z * one.error, one.mean + _EVIDENCE_Z * one.error
    ax.axhline(0, color=NOISE, lw=1)
    ax.fill_between(one.at, low, high, color=NOMINAL, alpha=0.22, lw=0)
    ax.plot(one.at, one.mean, "o-", color=NOMINAL, ms=3.5, lw=1.4)
    name = _NAMES.get(one.variable, one.variable.replace("_", " "))
    unit = f"in units {one.unit}" if one.unit.startswith("of ") else one.unit
    ax.set(xlabel=f"{name}, {unit}" if unit else name, ylabel=label)
    seen = np.concatenate([low, high])
    if not np.isfinite(seen).any():
        ax.text(0.5, 0.5, "no data", transform=ax.transAxes, ha="center", color=style.GREY)
    return ax


_BAR = 0.45


def lost_speed(ax: Axes, one: Loss) -> Axes:
    """A bar each, mm/s, in either direction, with its speed above it and its gait inside."""
    bars = (
        ("what the model as believed promises", one.believed, one.promised, "none", NOMINAL),
        (
            "what the robot as found reaches with that gait",
            one.believed,
            one.reached,
            NOMINAL,
            NOMINAL,
        ),
        ("what its own best gait reaches", one.best, one.speed, FINAL, FINAL),
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


def misfit(
    ax: Axes, nominal: Sequence[Misfit], refitted: Sequence[Misfit], final: Sequence[Misfit]
) -> Axes:
    """A row a recording, RMS in sigma over all channels."""
    rows = range(len(final))
    ax.hlines(
        rows, [one.rms for one in final], [one.rms for one in nominal], color=style.FAINT, lw=4
    )
    ax.plot([one.rms for one in nominal], rows, "o", ms=7, mfc="white", mec=NOMINAL, mew=1.8,
            label="as believed")  # fmt: skip
    ax.plot([one.rms for one in refitted], rows, "|", ms=11, mew=2, color=style.GREY,
            label="parameters re-estimated")  # fmt: skip
    ax.plot([one.rms for one in final], rows, "o", ms=7, color=FINAL, label="as found")
    ax.axvline(1.0, color=NOISE, lw=1, ls=(0, (4, 2)))
    names = [
        f"{one.recording.removesuffix('.csv')}{', held out' if one.held_out else ''}"
        for one in final
    ]
    ax.set_yticks(rows, names)
    for label, one in zip(ax.get_yticklabels(), final, strict=True):
        label.set_fontweight("bold" if one.held_out else "normal")
    ax.set_ylim(len(final) - 0.4, -0.6)
    ax.grid(visible=False, axis="y")
    largest = max(one.rms for one in (*nominal, *final))
    ax.set_xlim(0, 1.08 * max(largest, 1.5))
    if stretched(largest):
        ax.set(xscale="log", xlim=(0.8, 1.3 * largest))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda x, _: number(x, 2)))
        ax.xaxis.set_minor_formatter(FuncFormatter(lambda _x, _y: ""))
    ax.set_xlabel("misfit, in units of the noise σ")
    return ax


_POINTS = 1500
_FLAT = 0.6


def path(ax: Axes, recording: Recording, nominal: Misfit, final: Misfit) -> Axes:
    """The tracked point, m; how far off each simulation is, RMS, mm."""
    seen = np.column_stack([recording.data("x"), recording.data("y")])
    step = max(1, len(seen) // _POINTS)
    ax.plot(*seen[::step].T, color=RECORDED, lw=5, solid_capstyle="round", label="recorded")
    for one, colour, line, words in (
        (nominal, NOMINAL, "--", "as believed"),
        (final, FINAL, "-", "as found"),
    ):
        ax.plot(*one.predicted[::step, :2].T, line, color=colour, lw=1.4, label=words)
    known = np.flatnonzero(np.isfinite(seen).all(axis=1))
    if len(known):
        ax.plot(*seen[known[0]], "o", ms=6, color=style.OPTIMUM, mec=style.INK, zorder=4)
    off = [number(1e3 * _distance(seen, one), 2) for one in (nominal, final)]
    held = ", held out" if final.held_out else ""
    ax.set_title(f"{final.recording}{held}\n{off[0]} mm off → {off[1]} mm", fontsize=9.5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.set_ylabel("y, m")
    ax.tick_params(labelsize=8.5)
    ax.locator_params(nbins=5)
    return ax


def flat(recording: Recording) -> bool:
    """Whether a path is much wider than high."""
    width, height = (np.ptp(y[np.isfinite(y)]) for y in map(recording.data, ("x", "y")))
    return bool(height < _FLAT * width)


def _distance(seen: NDArray[np.float64], one: Misfit) -> float:
    """RMS distance between the recorded and the simulated path, m; the noise is part of it."""
    square = np.sum((one.predicted[:, :2] - seen) ** 2, axis=1)
    return float(np.sqrt(np.nanmean(square))) if np.isfinite(square).any() else float("nan")


_MOST_PATHS, _MOST_BANDS, _MOST_CURVES = 4, 4, 8


def draw(one: ExplainedExperiment) -> dict[str, tuple[str, str]]:
    """SVG text and caption by name, of the figures for which there is something."""
    makers = {
        "evidence": _evidence,
        "paths": _paths,
        "bands": _bands,
        "misfit": _misfit,
        "residue": _residue,
        "loss": _loss,
    }
    with style.styled():
        made = {name: make(one) for name, make in makers.items()}
        return {
            name: (style.svg(each[0]), each[1]) for name, each in made.items() if each is not None
        }


def _evidence(one: ExplainedExperiment) -> tuple[Figure, str] | None:
    curves = [
        (stage.name.replace("_", " "), each, _measured(stage))
        for stage in one.guilty
        for each in stage.curves
    ][:_MOST_CURVES]
    if not curves:
        return None
    rows = -(-len(curves) // 2)
    made = style.figure(style.WIDTH, 0.4 + 2.1 * rows)
    axes = np.atleast_1d(made.subplots(rows, min(len(curves), 2))).ravel()
    for ax, (_, each, label) in zip(axes, curves, strict=False):
        curve(ax, each, label)
    for ax in axes[len(curves) :]:
        ax.remove()
    names = dict.fromkeys(name for name, *_ in curves)
    return made, (
        f"The unknown input ({' and '.join(names)}) that would explain most of the misfit of the "
        "nominal model, with a 95 % band. Zero means that none is needed."
    )


def _measured(stage: Stage) -> str:
    """What the curves of a stage show."""
    return input_words(stage.channel)


def _paths(one: ExplainedExperiment) -> tuple[Figure, str]:
    shown = one.proof[:_MOST_PATHS]
    wide = all(flat(one.experiment.runs[k].recording) for k in shown)
    columns = 1 if wide else min(len(shown), 2)
    rows = -(-len(shown) // columns)
    made = style.figure(style.WIDTH, 0.8 + (1.9 if wide else 2.7) * rows)
    axes = np.atleast_1d(made.subplots(rows, columns)).ravel()
    for ax, k in zip(axes, shown, strict=False):
        path(ax, one.experiment.runs[k].recording, one.found.nominal[k], one.found.final[k])
    for ax in axes[len(shown) :]:
        ax.remove()
    made.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    for ax in axes[max(len(shown) - columns, 0) : len(shown)]:
        ax.set_xlabel("x, m")
    kind = "Held-out recordings" if one.marked else "The recordings"
    return made, (
        f"{kind}, worst first, seen from above; the dot marks the start. The distances are RMS "
        "and include the noise."
    )


def _bands(one: ExplainedExperiment) -> tuple[Figure, str]:
    shown = one.proof[:_MOST_BANDS]
    nominal, final = ([level[k] for k in shown] for level in (one.found.nominal, one.found.final))
    made = style.figure(style.WIDTH, 0.7 + 1.35 * len(SEEN))
    axes = list(made.subplots(len(SEEN), 1, sharex=True))
    bands(axes, nominal, final, SEEN)
    made.align_ylabels()
    handles = [axes[0].fill_between([], [], [], color=c, alpha=0.45) for c in (NOMINAL, FINAL)]
    line = axes[0].plot([], [], color=NOISE, ls=(0, (4, 2)), lw=1)
    labels = ["as believed", "as found", "the noise"]
    made.legend([*handles, *line], labels, loc="outside lower center", ncols=3)
    return made, (
        "Bands contain 95 % of each channel's residuals within a second and are dark where they "
        "overlap. Where blue just fills the space between the dashed lines, only noise is left."
    )


def _misfit(one: ExplainedExperiment) -> tuple[Figure, str]:
    found = one.found
    made = style.figure(style.WIDTH, 1.3 + 0.3 * len(found.final))
    misfit(ax := made.subplots(), found.nominal, found.refitted, found.final)
    made.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    held = "Held-out recordings took no part in the fit." if one.marked else (
        "All of them were fitted: mark one with `use: holdout` to see it predicted."
    )  # fmt: skip
    return (made, f"RMS difference between simulation and recording, in σ of the noise. {held}")


def _residue(one: ExplainedExperiment) -> tuple[Figure, str] | None:
    some = one.found.residue
    if not some:
        return None
    made = style.figure(style.WIDTH, 0.3 + 2.4 * len(some))
    for ax, each in zip(np.atleast_1d(made.subplots(len(some), 1)), some, strict=True):
        curve(ax, each, input_words(each.kind))
    return made, " ".join(each.sentence for each in some)


def _loss(one: ExplainedExperiment) -> tuple[Figure, str] | None:
    if not isinstance(one.loss, Loss):
        return None
    made = style.figure(style.WIDTH, 3.0)
    lost_speed(made.subplots(), one.loss)
    return made, loss_sentences(one.loss)
