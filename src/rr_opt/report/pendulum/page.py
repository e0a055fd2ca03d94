"""The page on a real pendulum."""

from __future__ import annotations

import math

from rr_opt.diagnose.diagnosis import Estimate
from rr_opt.report.pendulum.told import WORDS, Told, rms_of


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
{_values(told)}

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


def _values(told: Told) -> str:
    rows = []
    for name, value in told.values.items():
        cells = " | ".join(_cell(cut.terms[name]) for cut in told.cuts)
        other = f"{told.elsewhere[name]:.3f}" if name in told.elsewhere else ""
        rows.append(f"| {WORDS[name]} | {value:.3g} | {other} | {cells} |")
    return "\n".join(rows)


def _cell(one: Estimate) -> str:
    return f"{one.value:.3f} [{one.low:.3f}, {one.high:.3f}]"
