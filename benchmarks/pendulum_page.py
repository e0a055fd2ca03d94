"""The page on a real pendulum."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from rr_opt.array import Array
from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY, INK, figure, styled, svg
from rr_opt.sysid.diagnosis import Diagnosis, Estimate, Misfit
from rr_opt.sysid.model import Data


@dataclass(frozen=True)
class Cut:
    """A diagnosis of the recording in parts, of which some are held out (numbered from 1).

    terms  all published terms fitted by simulation error, needed or not
    """

    parts: int
    held_out: tuple[int, ...]
    found: Diagnosis
    terms: Mapping[str, Estimate]


@dataclass(frozen=True)
class Told:
    """What the page, the figure and the record show; the first of `cuts` is shown.

    sigma      of the angle, rad: what of it is faster than `rigid`, Hz
    factor     within which the published values were believed
    values     as published;  elsewhere  in the lab's other files;  atan  factor of atan(100 w), N m
    published  misfit of the published model in the first cut
    torque_error  white error of the torque's samples that would leave the misfit found, N m
    regressed  inertia by linear regression, by cutoff of the low pass, Hz
    """

    digest: str
    sigma: float
    rigid: float
    factor: float
    values: Mapping[str, float]
    elsewhere: Mapping[str, float]
    atan: float
    published: Sequence[Misfit]
    torque_error: float
    regressed: Mapping[float, float]
    cuts: Sequence[Cut]


WORDS = {
    "J": "inertia, kg m²",
    "ml": "mass times length, kg m",
    "b": "viscous friction, N m s",
    "coulomb_friction.torque": "Coulomb friction, N m",
    "torque_offset.torque": "torque offset, N m",
}


def rms_of(parts: Sequence[Misfit]) -> float:
    """Over all samples, in sigma."""
    return float(np.sqrt(np.mean(np.concatenate([one.residuals.ravel() for one in parts]) ** 2)))


def record(told: Told) -> Mapping[str, Any]:
    """Everything as JSON."""
    return {
        "data_sha256": told.digest,
        "sigma_rad": told.sigma,
        "published": told.values,
        "published_rms_sigma": {one.recording: one.rms for one in told.published},
        "torque_error_Nm": told.torque_error,
        "inertia_by_regression": {f"{cutoff:g} Hz": J for cutoff, J in told.regressed.items()},
        "cuts": [_cut(one) for one in told.cuts],
    }


def _cut(one: Cut) -> Mapping[str, Any]:
    return {
        "parts": one.parts,
        "held_out": one.held_out,
        "verdict": one.found.verdict,
        "summary": one.found.summary,
        "findings": [asdict(finding) for finding in one.found.findings],
        "parameters": {name: asdict(value) for name, value in one.found.parameters.items()},
        "rms_sigma": {part.recording: part.rms for part in one.found.final},
        "tried": [
            {"effects": tried.effects, "fit": tried.fit, "score": tried.score, **tried.values}
            for tried in one.found.tried
        ],
        "published_terms": {name: asdict(value) for name, value in one.terms.items()},
    }


def drawn(runs: Sequence[Data], begins: Array, told: Told) -> str:
    """SVG text: angle and misfit over time (parts begin at `begins`, s), and the values."""
    published, fitted = told.published, told.cuts[0].found.final
    with styled():
        page = figure(8.2, 8.6)
        angle, misfit, values = page.subplots(3, 1, height_ratios=(3, 2, 2.4))
        _angles(angle, runs, begins, published, fitted)
        for parts, colour in ((published, BACKWARD), (fitted, FORWARD)):
            for run, begin, part in zip(runs, begins, parts, strict=True):
                off = (part.predicted - run.values)[:, 0]
                misfit.plot(run.t + begin, 1e3 * off, color=colour, linewidth=1)
        misfit.set(xlabel="time, s", ylabel="simulated less\nrecorded, mrad")
        _values(values, told)
        return svg(page)


def _angles(
    ax: Axes,
    runs: Sequence[Data],
    begins: Array,
    published: Sequence[Misfit],
    fitted: Sequence[Misfit],
) -> None:
    for k, (run, begin) in enumerate(zip(runs, begins, strict=True)):
        if run.held_out:
            ax.axvspan(begin, begin + run.t[-1], color=GREY, alpha=0.12, label="held out")
        curves = (
            (run.values, INK, 4.0, "recorded"),
            (published[k].predicted, BACKWARD, 1.4, "published values, simulated"),
            (fitted[k].predicted, FORWARD, 1.4, "fitted by simulation error"),
        )
        for values, colour, width, label in curves:
            faint = 0.35 if width > 2 else 1.0
            name = label if k == 0 else None
            ax.plot(run.t + begin, values[:, 0], colour, lw=width, alpha=faint, label=name)
    ax.set(ylabel="angle, rad", title="Each part starts anew where it fits best")
    ax.legend(loc="upper left")


def _values(ax: Axes, told: Told) -> None:
    """Each value as a multiple of the published one."""
    for row, (name, published) in enumerate(told.values.items()):
        one = told.cuts[0].terms[name]
        at, low, high = (value / published for value in (one.value, one.low, one.high))
        ax.plot([low, high], [row, row], color=FORWARD, lw=4, alpha=0.4)
        ax.plot(at, row, "o", color=FORWARD)
    ax.axvline(1, color=BACKWARD)
    labels = [f"{WORDS[name]}: {published:.3g}" for name, published in told.values.items()]
    ax.set_yticks(np.arange(len(labels)), labels)
    ax.set_ylim(len(labels) - 0.5, -0.5)
    ax.set(xlabel="fitted, with 95 % interval, as a multiple of the published value")


def page(told: Told) -> str:
    """What was found, in Markdown."""
    first = told.cuts[0]
    mrad = 1e3 * told.sigma
    tried = "; ".join(
        f"{' and '.join(one.effects) or 'none'} {mrad * math.hypot(one.fit, 1):.1f}"
        for one in first.found.tried
    )
    heads = " | ".join(f"{cut.parts} part{'s' * (cut.parts > 1)}" for cut in told.cuts)
    before, after = (mrad * rms_of(one) for one in (told.published, first.found.final))
    cutoffs = ", ".join(f"{cutoff:g}" for cutoff in told.regressed)
    inertias = ", ".join(f"{one:.3f}" for one in told.regressed.values())
    J, ml = told.elsewhere["J"], told.elsewhere["ml"]
    dry = told.values["coulomb_friction.torque"]
    return f"""# A real pendulum

Written by `make real DATA=PATH`. The recording is that of the torque-limited simple pendulum of the
DFKI RIC Underactuated Robotics Lab (BSD 3-Clause): one swing-up of 3.9 s under PD control at
300 Hz, with the torque read from the motor's current. It is not kept here. The model had viscous
friction only, with the published inertia, mass times length and viscous friction, each within a
factor of {told.factor:g}. Noise: the angle faster than {told.rigid:g} Hz, {mrad:.1f} mrad RMS,
most of it a vibration at 50 to 70 Hz.

![angle, misfit and values](pendulum.svg)

## What it said

| parts | held out | verdict | named | J, kg m² | ml, kg m | b, N m s | misfit, mrad |
|---|---|---|---|---|---|---|---|
{_verdicts(told)}

There is one recording, so it is cut into parts that start anew. The first line is the one shown;
the others show whether the cut matters. The misfit is that of all parts. In the first cut, that of
the fitted parts with each effect that was tried, in mrad:
{tried}.

1. The published model with all its published terms, each part starting where it fits best, is off
   by {before:.0f} mrad; with the values found it is {after:.0f} mrad. The lab's own parameter files
   for this pendulum (0.6755 kg at 0.5 m) have {J:.3f} kg m² and {ml:.3f} kg m.
   The published values are from a linear regression on filtered second derivatives of the angle.
   Such a regression, with low passes at {cutoffs} Hz, gives an inertia of
   {inertias} kg m².
2. Independent errors of the torque's samples of {told.torque_error:.2g} N m RMS would leave as much
   misfit as is left. The torque was read with single samples of up to 17 N m.
3. Coulomb friction is named in {_naming(told)} of {len(told.cuts)} cuts. With all published terms
   in the model (below), its interval holds the published {dry:.3f} N m in {_holding(told, dry)},
   {told.atan:.3f} N m in {_holding(told, told.atan)}, and none at all in {_holding(told, 0.0)}.

## Against the published values

All published terms, fitted by simulation error whether they are needed or not:

| | published | in the parameter files | {heads} |
|---|---|---|{"---|" * len(told.cuts)}
{_page_values(told)}

Published as Coulomb friction was Fc = {told.atan:.3f} N m, in a law Fc atan(100 w). As atan tends
to pi/2, the friction of a moving pendulum is Fc pi/2 = {dry:.3f} N m, which stands in the table.
The offset stands there as what the motor gives more than its reading.

The intervals are those of a model that is known to be incomplete: they are widened by the misfit
that is left, samples of half a second (150) counting as one. Where an interval of friction begins
at 0, none would do as well.

The effect `torque_limit` came into the catalogue after a first look at this recording; the other
five were there before.
"""


def _naming(told: Told) -> int:
    return sum("coulomb_friction" in [f.name for f in cut.found.findings] for cut in told.cuts)


def _holding(told: Told, torque: float) -> int:
    """In how many cuts the interval of Coulomb friction holds a torque, N m."""
    found = [cut.terms["coulomb_friction.torque"] for cut in told.cuts]
    return sum(one.low <= torque <= one.high for one in found)


def _verdicts(told: Told) -> str:
    rows = []
    for cut in told.cuts:
        out = ", ".join(map(str, cut.held_out)) or "none"
        values = " | ".join(_cell(cut.found.parameters[name]) for name in ("J", "ml", "b"))
        named = ", ".join(one.name for one in cut.found.findings) or "nothing"
        off = 1e3 * told.sigma * rms_of(cut.found.final)
        rows.append(
            f"| {cut.parts} | {out} | {cut.found.verdict} | {named} | {values} | {off:.0f} |"
        )
    return "\n".join(rows)


def _page_values(told: Told) -> str:
    rows = []
    for name, value in told.values.items():
        cells = " | ".join(_cell(cut.terms[name]) for cut in told.cuts)
        other = f"{told.elsewhere[name]:.3f}" if name in told.elsewhere else ""
        rows.append(f"| {WORDS[name]} | {value:.3g} | {other} | {cells} |")
    return "\n".join(rows)


def _cell(one: Estimate) -> str:
    return f"{one.value:.3f} [{one.low:.3f}, {one.high:.3f}]"
