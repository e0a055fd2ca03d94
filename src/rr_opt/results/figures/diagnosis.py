"""How well the nominal and the corrected model predict the recordings, in sigma."""

import itertools
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from rr_opt.array import Array
from rr_opt.formatting import number
from rr_opt.model.experiment import CHANNELS, Recording
from rr_opt.results.diagnosis import ExplainedExperiment
from rr_opt.results.figures import style
from rr_opt.results.loss import Loss, gait_words, loss_sentences, pace
from rr_opt.results.machine_diagnosis import ExplainedMachine
from rr_opt.sysid.diagnosis import Curve, Misfit, Residue

_SYMBOLS = {"psi": "ψ", "phi": "φ"}
_MOST = 4
"""Most recordings in the bands."""
_WIDE = 8.0
"""Sigma above which a linear axis would hide the noise."""
_LINEAR = 4.0
"""Range in sigma over which a stretched axis is linear."""
_MARKS = (0, *(sign * 10**power for power in range(1, 7) for sign in (-1, 1)))
_Z, _ENDS = 1.96, (2.5, 97.5)


def bands(one: ExplainedExperiment) -> tuple[Figure, str]:
    """95 % of the residuals over time, an axes for each channel, one recording after the other."""
    shown = one.proof[:_MOST]
    nominal, final = ([level[k] for k in shown] for level in (one.found.nominal, one.found.final))
    starts = np.concatenate([[0.0], np.cumsum([each.t[-1] - each.t[0] for each in final])])
    made = style.figure(height=0.7 + 1.35 * len(CHANNELS))
    axes = list(made.subplots(len(CHANNELS), 1, sharex=True))
    for k, (ax, name) in enumerate(zip(axes, CHANNELS, strict=True)):
        largest = 0.0
        levels = (nominal, style.NOMINAL, "nominal"), (final, style.FOUND, "corrected")
        for level, colour, words in levels:
            for start, each in zip(starts, level, strict=False):
                at, low, high = _band(each.t, each.residuals[:, k])
                here = at - each.t[0] + start
                ax.fill_between(here, low, high, color=colour, alpha=0.45, lw=0.8, step="mid",
                                label=f"_{words}")  # fmt: skip
                largest = max([largest, *np.abs([*low, *high])[np.isfinite([*low, *high])]])
        for end in (-_Z, _Z):
            ax.axhline(end, color=style.GREY, lw=1, ls=style.DASHED)
        for edge in starts[1:-1]:
            ax.axvline(edge, color=style.GREY, lw=0.8)
        if largest > _WIDE:
            ax.set_yscale("symlog", linthresh=_LINEAR, linscale=1)
            ax.yaxis.set_major_locator(FixedLocator(_MARKS))
            ax.yaxis.set_minor_locator(NullLocator())
            ax.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
        ax.set(ylabel=f"{_SYMBOLS.get(name, name)}, σ", xlim=(0, starts[-1]))
    for (first, last), each in zip(itertools.pairwise(starts), final, strict=True):
        axes[0].text((first + last) / 2, 1.03, each.recording.removesuffix(".csv"), ha="center",
                     va="bottom", fontsize=9, color=style.GREY,
                     transform=axes[0].get_xaxis_transform())  # fmt: skip
    axes[-1].set_xlabel("time, one recording after the other, s")
    made.align_ylabels()
    for words, colour in (("nominal", style.NOMINAL), ("corrected", style.FOUND)):
        axes[0].fill_between([], [], [], color=colour, alpha=0.45, label=words)
    axes[0].plot([], [], color=style.GREY, ls=style.DASHED, lw=1, label="the noise")
    style.legend_below(made, axes[0])
    return made, (
        "Bands contain 95 % of each channel's residuals in each second and are dark where they "
        "overlap. Where blue just fills the space between the dashed lines, only noise remains. An "
        f"axis that exceeds {_WIDE:g} σ is logarithmic beyond {_LINEAR:g} σ."
    )


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


def misfits(one: ExplainedExperiment) -> tuple[Figure, str]:
    """A lane for each recording: RMS in sigma over all channels."""
    final = one.found.final
    levels = (one.found.nominal, one.found.refitted, final)
    nominal, refitted, found = ([each.rms for each in level] for level in levels)
    lanes, largest = range(len(final)), max(*nominal, *found)
    made = style.figure(height=1.3 + 0.3 * len(final))
    ax = made.subplots()
    ax.hlines(lanes, found, nominal, color=style.FAINT, lw=4)
    ax.plot(nominal, lanes, "o", ms=7, mfc="white", mec=style.NOMINAL, mew=1.8, label="nominal")
    ax.plot(refitted, lanes, "|", ms=11, mew=2, color=style.GREY, label="parameters re-estimated")
    ax.plot(found, lanes, "o", ms=7, color=style.FOUND, label="corrected")
    ax.axvline(1.0, color=style.GREY, lw=1, ls=style.DASHED)
    names = [each.recording.removesuffix(".csv") for each in final]
    held = [", held out" if each.held_out else "" for each in final]
    style.lanes(ax, list(map("".join, zip(names, held, strict=True))))
    for label, apart in zip(ax.get_yticklabels(), held, strict=True):
        label.set_fontweight("bold" if apart else "normal")
    ax.set(xlabel="misfit, in units of the noise σ", xlim=(0, 1.08 * max(largest, 1.5)))
    if largest > _WIDE:
        ax.set(xscale="log", xlim=(0.8, 1.3 * largest))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda x, _: number(x, 2)))
        ax.xaxis.set_minor_formatter(FuncFormatter(lambda _x, _y: ""))
    style.legend_below(made, ax)
    proof = "Held-out recordings took no part in the fit." if one.marked else (
        "All of them were fitted: mark one with `use: holdout` to see it predicted."
    )  # fmt: skip
    return made, f"RMS difference between simulation and recording, in σ of the noise. {proof}"


_MOST_PATHS, _MOST_CURVES = 4, 8


def draw(one: ExplainedExperiment) -> dict[str, tuple[str, str]]:
    """SVG text and caption by name, of the figures that have content."""
    makers = {
        "evidence": _evidence,
        "paths": _paths,
        "bands": bands,
        "misfit": misfits,
        "residue": _residue,
        "loss": _loss,
    }
    made = {name: make(one) for name, make in makers.items()}
    return {name: (style.svg(each[0]), each[1]) for name, each in made.items() if each}


def _evidence(one: ExplainedExperiment) -> tuple[Figure, str] | None:
    curves = [(stage, each) for stage in one.guilty for each in stage.curves][:_MOST_CURVES]
    if not curves:
        return None
    shown = [(each, _input_words(stage.channel)) for stage, each in curves]
    made = _curves(shown, 0.4 + 2.1 * -(-len(curves) // 2), 2)
    names = dict.fromkeys(stage.name.replace("_", " ") for stage, _ in curves)
    return made, (
        f"The unknown input ({' and '.join(names)}) that would explain most of the misfit of the "
        "nominal model, with a 95 % band. Zero means none is needed."
    )


def _residue(one: ExplainedExperiment) -> tuple[Figure, str] | None:
    some = one.found.residue
    if not some:
        return None
    made = _curves([(each, _input_words(each.kind)) for each in some], 0.3 + 2.4 * len(some), 1)
    return made, " ".join(each.sentence for each in some)


_NAMES = {
    "phase": "phase of the cycle",
    "rate": "commanded rate",
    "along": "position along x",
    "across": "position along y",
    "time": "time since the start",
}


def _curves(shown: Sequence[tuple[Curve | Residue, str]], height: float, columns: int) -> Figure:
    """Curves, each with the words for its unknown input, in at most so many columns."""
    made = style.figure(height=height)
    for ax, each in zip(style.grid(made, len(shown), min(len(shown), columns)), shown, strict=True):
        _curve(ax, *each)
    return made


def _curve(ax: Axes, one: Curve | Residue, input: str) -> None:
    """The mean in bins with its 95 % band; at zero there is no fault."""
    low, high = one.mean - _Z * one.error, one.mean + _Z * one.error
    ax.axhline(0, color=style.GREY, lw=1)
    ax.fill_between(one.at, low, high, color=style.NOMINAL, alpha=0.22, lw=0)
    ax.plot(one.at, one.mean, "o-", color=style.NOMINAL, ms=3.5, lw=1.4)
    name = _NAMES.get(one.variable, one.variable.replace("_", " "))
    unit = f"in units {one.unit}" if one.unit.startswith("of ") else one.unit
    ax.set(xlabel=f"{name}, {unit}" if unit else name, ylabel=input)
    if not np.isfinite([*low, *high]).any():
        ax.text(0.5, 0.5, "no data", transform=ax.transAxes, ha="center", color=style.GREY)


def _input_words(channel: str) -> str:
    """What an unknown input of a channel is, with its unit."""
    if channel == "actuation":
        return "angle, rad"
    return "side speed, m/s" if channel.startswith("constraint") else "force per wheel, N"


_POINTS = 1500
_FLAT = 0.6
"""A path flatter than this (height over width) gets its own row."""


def _paths(one: ExplainedExperiment) -> tuple[Figure, str]:
    shown = one.proof[:_MOST_PATHS]
    places = (map(one.experiment.runs[k].recording.data, ("x", "y")) for k in shown)
    sizes = ([np.ptp(values[np.isfinite(values)]) for values in xy] for xy in places)
    wide = all(height < _FLAT * width for width, height in sizes)
    columns = 1 if wide else min(len(shown), 2)
    made = style.figure(height=0.8 + (1.9 if wide else 2.7) * -(-len(shown) // columns))
    axes = style.grid(made, len(shown), columns)
    for ax, k in zip(axes, shown, strict=True):
        _path(ax, one.experiment.runs[k].recording, one.found.nominal[k], one.found.final[k])
    style.legend_below(made, axes[0])
    for ax in axes[-columns:]:
        ax.set_xlabel("x, m")
    kind = "Held-out recordings" if one.marked else "The recordings"
    return made, (
        f"{kind}, worst first, seen from above; the dot marks the start. The distances are RMS "
        "and include the noise."
    )


def _path(ax: Axes, recording: Recording, nominal: Misfit, final: Misfit) -> None:
    """The tracked point, m; the RMS distance of each simulation from it, mm."""
    seen = np.column_stack([recording.data("x"), recording.data("y")])
    step = max(1, len(seen) // _POINTS)
    ax.plot(*seen[::step].T, color="#b4bdc6", lw=5, solid_capstyle="round", label="recorded")
    for one, colour, line, words in (
        (nominal, style.NOMINAL, "--", "nominal"),
        (final, style.FOUND, "-", "corrected"),
    ):
        ax.plot(*one.predicted[::step, :2].T, line, color=colour, lw=1.4, label=words)
    known = np.flatnonzero(np.isfinite(seen).all(axis=1))
    if len(known):
        ax.plot(*seen[known[0]], "o", ms=6, color=style.OPTIMUM, mec=style.INK, zorder=4)
    off = [number(1e3 * _distance(recording.t, seen, one), 2) for one in (nominal, final)]
    held = ", held out" if final.held_out else ""
    ax.set_title(f"{final.recording}{held}\n{off[0]} mm off → {off[1]} mm", fontsize=9.5)
    ax.margins(0.08)
    ax.set(aspect="equal", adjustable="datalim", ylabel="y, m")
    ax.tick_params(labelsize=8.5)
    ax.locator_params(nbins=5)


def _distance(t: Array, seen: Array, one: Misfit) -> float:
    """RMS distance between the recorded and the simulated path, m, with the noise in it. A misfit
    has rows also where the recording lacks some."""
    predicted = one.predicted[np.searchsorted(one.t, t), :2]
    square = np.sum((predicted - seen) ** 2, axis=1)
    return float(np.sqrt(np.nanmean(square))) if np.isfinite(square).any() else float("nan")


_BAR = 0.45


def _loss(one: ExplainedExperiment) -> tuple[Figure, str] | None:
    """Two bars, mm/s, in either direction, labelled with their speed and gait."""
    loss, nominal, found = one.loss, style.NOMINAL, style.FOUND
    if not isinstance(loss, Loss):
        return None
    made = style.figure(height=3.0)
    ax = made.subplots()
    bars = (
        ("the nominal model promises", loss.believed, loss.promised, "none", nominal),
        ("the corrected robot reaches with it", loss.believed, loss.reached, nominal, nominal),
        ("its own best gait reaches", loss.best, loss.speed, found, found),
    )
    for row, (words, gait, speed, inside, edge) in enumerate(bars):
        ax.barh(row, 1e3 * abs(speed), _BAR, color=inside, edgecolor=edge, lw=1.4)
        ax.text(0, row - _BAR / 2 - 0.06, f"{words}: {pace(speed)}", va="bottom", fontsize=9.5)
        ink = "white" if inside != "none" else edge
        ax.text(0.02, row, gait_words(gait), va="center", fontsize=9, color=ink,
                transform=ax.get_yaxis_transform())  # fmt: skip
    style.lanes(ax, [""] * len(bars))
    ax.set(ylim=(len(bars) - 0.65, -0.75), xlabel="mean speed, mm/s")
    return made, loss_sentences(loss)


_MOST_PARTS, _MOST_POINTS = 12, 2000
"""Most parts of recordings, held-out ones if any; most points of a line."""


def draw_machine(one: ExplainedMachine) -> dict[str, str]:
    """SVG text by name."""
    made = {"errors": _errors(one), "unknown": _unknown(one)}
    return {name: style.svg(each) for name, each in made.items() if each}


def _errors(one: ExplainedMachine) -> Figure:
    outputs = one.experiment.machine.outputs
    found = one.found
    rows = [k for k, m in enumerate(found.final) if m.held_out] or list(range(len(found.final)))
    shown = rows[:_MOST_PARTS]
    every = max(sum(found.final[row].t.size for row in shown) // _MOST_POINTS, 1)
    made = style.figure(height=0.8 + 1.7 * len(outputs))
    axes = np.atleast_1d(made.subplots(len(outputs), 1, sharex=True))
    for k, (ax, channel) in enumerate(zip(axes, outputs, strict=True)):
        for level, colour, label in (
            (found.refitted, style.NOMINAL, "values fitted, no effect"),
            (found.final, style.FOUND, "corrected"),
        ):
            start = 0.0
            for row in shown:
                m = level[row]
                t = m.t - m.t[0] + start
                off = (m.predicted - m.recorded)[:, k]
                words = label if start == 0 else None
                ax.plot(t[::every], off[::every], color=colour, lw=1.2, label=words)
                start = float(t[-1])
        ax.axhline(0, color=style.GREY, lw=0.8)
        ax.set(ylabel=f"{channel.name} off, {channel.unit}")
    axes[-1].set_xlabel("time, one recording after the other, s")
    style.legend_below(made, axes[0])
    return made


def _unknown(one: ExplainedMachine) -> Figure | None:
    curves = [c for stage in one.found.stages for c in stage.curves if c.at.size > 1]
    if not curves:
        return None
    unit = next(iter(one.experiment.machine.ports.values()))[1]
    return _curves([(curve, f"unknown, {unit}") for curve in curves], 2.6, 2)
