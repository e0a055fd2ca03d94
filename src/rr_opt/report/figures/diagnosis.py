"""Figures of a diagnosis: evidence, paths and misfits before and after, lost speed."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rr_opt.array import Array
from rr_opt.formatting import number
from rr_opt.model.experiment import Recording
from rr_opt.report.diagnosis.loss import gait_words, loss_sentences, pace
from rr_opt.report.figures import style
from rr_opt.report.figures.misfits import bands, misfits
from rr_opt.results.diagnosis import ExplainedExperiment
from rr_opt.results.loss import Loss
from rr_opt.sysid.diagnosis import Curve, Misfit, Residue

_MOST_PATHS, _MOST_CURVES = 4, 8


def draw(one: ExplainedExperiment) -> dict[str, tuple[str, str]]:
    """SVG text and caption by name, of the figures for which there is something."""
    makers = {
        "evidence": _evidence,
        "paths": _paths,
        "bands": bands,
        "misfit": misfits,
        "residue": _residue,
        "loss": _loss,
    }
    with style.styled():
        made = {name: make(one) for name, make in makers.items()}
        return {name: (style.svg(each[0]), each[1]) for name, each in made.items() if each}


def _evidence(one: ExplainedExperiment) -> tuple[Figure, str] | None:
    curves = [(stage, each) for stage in one.guilty for each in stage.curves][:_MOST_CURVES]
    if not curves:
        return None
    rows = -(-len(curves) // 2)
    made = style.figure(height=0.4 + 2.1 * rows)
    axes = style.grid(made, len(curves), min(len(curves), 2))
    for ax, (stage, each) in zip(axes, curves, strict=True):
        _curve(ax, each, stage.channel)
    names = dict.fromkeys(stage.name.replace("_", " ") for stage, _ in curves)
    return made, (
        f"The unknown input ({' and '.join(names)}) that would explain most of the misfit of the "
        "nominal model, with a 95 % band. Zero means that none is needed."
    )


def _residue(one: ExplainedExperiment) -> tuple[Figure, str] | None:
    some = one.found.residue
    if not some:
        return None
    made = style.figure(height=0.3 + 2.4 * len(some))
    for ax, each in zip(style.grid(made, len(some), 1), some, strict=True):
        _curve(ax, each, each.kind)
    return made, " ".join(each.sentence for each in some)


_Z = 1.96
_NAMES = {
    "phase": "phase of the cycle",
    "rate": "commanded rate",
    "along": "place along x",
    "across": "place along y",
    "time": "time since the start",
}


def _curve(ax: Axes, one: Curve | Residue, channel: str) -> None:
    """The mean in bins with its 95 % band; at zero there is no fault."""
    low, high = one.mean - _Z * one.error, one.mean + _Z * one.error
    ax.axhline(0, color=style.GREY, lw=1)
    ax.fill_between(one.at, low, high, color=style.NOMINAL, alpha=0.22, lw=0)
    ax.plot(one.at, one.mean, "o-", color=style.NOMINAL, ms=3.5, lw=1.4)
    name = _NAMES.get(one.variable, one.variable.replace("_", " "))
    unit = f"in units {one.unit}" if one.unit.startswith("of ") else one.unit
    ax.set(xlabel=f"{name}, {unit}" if unit else name, ylabel=_input_words(channel))
    if not np.isfinite([*low, *high]).any():
        ax.text(0.5, 0.5, "no data", transform=ax.transAxes, ha="center", color=style.GREY)


def _input_words(channel: str) -> str:
    """What an unknown input of a channel is, with its unit."""
    if channel == "actuation":
        return "angle, rad"
    return "side speed, m/s" if channel.startswith("constraint") else "force per wheel, N"


_POINTS = 1500
_FLAT = 0.6
"""A path that is lower than this share of its width gets a row of its own."""


def _paths(one: ExplainedExperiment) -> tuple[Figure, str]:
    shown = one.proof[:_MOST_PATHS]
    wide = all(_flat(one.experiment.runs[k].recording) for k in shown)
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
        (nominal, style.NOMINAL, "--", "as believed"),
        (final, style.FOUND, "-", "as found"),
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


def _flat(recording: Recording) -> bool:
    width, height = (np.ptp(y[np.isfinite(y)]) for y in map(recording.data, ("x", "y")))
    return bool(height < _FLAT * width)


def _distance(seen: Array, one: Misfit) -> float:
    """RMS distance between the recorded and the simulated path, m, with the noise in it."""
    square = np.sum((one.predicted[:, :2] - seen) ** 2, axis=1)
    return float(np.sqrt(np.nanmean(square))) if np.isfinite(square).any() else float("nan")


_BAR = 0.45


def _loss(one: ExplainedExperiment) -> tuple[Figure, str] | None:
    """A bar each, mm/s, in either direction, with its speed above it and its gait inside."""
    loss, nominal, found = one.loss, style.NOMINAL, style.FOUND
    if not isinstance(loss, Loss):
        return None
    made = style.figure(height=3.0)
    ax = made.subplots()
    bars = (
        ("the model as believed promises", loss.believed, loss.promised, "none", nominal),
        ("the robot as found reaches with it", loss.believed, loss.reached, nominal, nominal),
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
