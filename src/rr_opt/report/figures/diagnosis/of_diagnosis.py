"""All figures of a diagnosis, with their captions."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rr_opt.diagnose.diagnosis import Stage
from rr_opt.experiment.recording import CHANNELS
from rr_opt.report.diagnosis.diagnosed import Diagnosed
from rr_opt.report.diagnosis.loss import Loss
from rr_opt.report.diagnosis.loss_words import loss_sentences
from rr_opt.report.figures.diagnosis.bands import bands
from rr_opt.report.figures.diagnosis.evidence import curve
from rr_opt.report.figures.diagnosis.look import FINAL, NOISE, NOMINAL, WIDTH
from rr_opt.report.figures.diagnosis.lost_speed import lost_speed
from rr_opt.report.figures.diagnosis.misfit import misfit
from rr_opt.report.figures.diagnosis.paths import flat, path
from rr_opt.report.figures.style import figure, styled, svg

NAMES = ("evidence", "paths", "bands", "misfit", "residue", "loss")

_MOST_PATHS, _MOST_BANDS, _MOST_CURVES = 4, 4, 8


def draw(one: Diagnosed) -> tuple[dict[str, str], dict[str, str]]:
    """SVG texts by name, and what to write under each; those for which there is something."""
    drawn: dict[str, str] = {}
    told: dict[str, str] = {}
    makers = (_evidence, _paths, _bands, _misfit, _residue, _loss)
    with styled():
        for name, make in zip(NAMES, makers, strict=True):
            made = make(one)
            if made is not None:
                drawn[name], told[name] = svg(made[0]), made[1]
    return drawn, told


def _evidence(one: Diagnosed) -> tuple[Figure, str] | None:
    curves = [
        (stage.name.replace("_", " "), each, _measured(stage))
        for stage in one.guilty
        for each in stage.curves
    ][:_MOST_CURVES]
    if not curves:
        return None
    rows = -(-len(curves) // 2)
    made = figure(WIDTH, 0.4 + 2.1 * rows)
    axes = np.atleast_1d(made.subplots(rows, min(len(curves), 2))).ravel()
    for ax, (_, each, label) in zip(axes, curves, strict=False):
        curve(ax, each, label)
    for ax in axes[len(curves) :]:
        ax.remove()
    names = dict.fromkeys(name for name, *_ in curves)
    return made, (
        f"Residual of the stage {' and '.join(names)}, mean in bins with a 95 % band. On the line "
        "at zero there is no fault."
    )


def _measured(stage: Stage) -> str:
    """What the curves of a stage show."""
    if stage.channel == "actuation":
        return "residual, σ"
    if stage.channel == "measurement" or stage.channel.startswith("constraint"):
        return "side speed, σ/s"
    return "acceleration, σ/s²"


def _paths(one: Diagnosed) -> tuple[Figure, str]:
    shown = one.proof[:_MOST_PATHS]
    wide = all(flat(one.experiment.runs[k].recording) for k in shown)
    columns = 1 if wide else min(len(shown), 2)
    rows = -(-len(shown) // columns)
    made = figure(WIDTH, 0.8 + (1.9 if wide else 2.7) * rows)
    axes = np.atleast_1d(made.subplots(rows, columns)).ravel()
    for ax, k in zip(axes, shown, strict=False):
        path(ax, one.experiment.runs[k].recording, one.found.nominal[k], one.found.final[k])
    for ax in axes[len(shown) :]:
        ax.remove()
    made.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    for ax in axes[max(len(shown) - columns, 0) : len(shown)]:
        ax.set_xlabel("x, m")
    kind = "Recordings that were kept apart from the fit" if one.marked else "The recordings"
    return made, (
        f"{kind}, the worst first, seen from above; the dot is where it starts. How far the "
        "simulated path is off, RMS, includes the noise."
    )


def _bands(one: Diagnosed) -> tuple[Figure, str]:
    shown = one.proof[:_MOST_BANDS]
    nominal, final = ([level[k] for k in shown] for level in (one.found.nominal, one.found.final))
    made = figure(WIDTH, 0.7 + 1.35 * len(CHANNELS))
    axes = list(made.subplots(len(CHANNELS), 1, sharex=True))
    bands(axes, nominal, final, CHANNELS)
    made.align_ylabels()
    handles = [axes[0].fill_between([], [], [], color=c, alpha=0.45) for c in (NOMINAL, FINAL)]
    line = axes[0].plot([], [], color=NOISE, ls=(0, (4, 2)), lw=1)
    labels = ["as believed", "as found", "the noise"]
    made.legend([*handles, *line], labels, loc="outside lower center", ncols=3)
    return made, (
        "Bands hold 95 % of what is left of each channel in a second, dark where both lie on each "
        "other. Where blue just fills the space between the broken lines, only noise is left."
    )


def _misfit(one: Diagnosed) -> tuple[Figure, str]:
    found = one.found
    made = figure(WIDTH, 1.3 + 0.3 * len(found.final))
    misfit(ax := made.subplots(), found.nominal, found.refitted, found.final)
    made.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    held = "Held-out recordings took no part in the fit." if one.marked else (
        "All of them were fitted: mark one with `use: holdout` to see it predicted."
    )  # fmt: skip
    return made, f"RMS of simulated less recorded over all channels, in σ of the noise. {held}"


def _residue(one: Diagnosed) -> tuple[Figure, str] | None:
    some = one.found.residue
    if not some:
        return None
    made = figure(WIDTH, 0.3 + 2.4 * len(some))
    for ax, each in zip(np.atleast_1d(made.subplots(len(some), 1)), some, strict=True):
        curve(ax, each, f"{each.kind.replace('_', ' ')}, N")
    return made, " ".join(each.sentence for each in some)


def _loss(one: Diagnosed) -> tuple[Figure, str] | None:
    if not isinstance(one.loss, Loss):
        return None
    made = figure(WIDTH, 3.0)
    lost_speed(made.subplots(), one.loss)
    return made, loss_sentences(one.loss)
