"""The diagnosis of a Roller Racer: the engine's answer, and what only this machine can tell.

Where on the way from the command to the floor the fault enters, what the remainder depends on and
what it is worth, and which recording to make next.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from rr_opt.machines.racer.next_experiment import next_experiment
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.unknown_terms import CHANNELS, CONSTANT, unknown_terms
from rr_opt.sysid.diagnose import Result, Stopwatch, answer, identified, rival_of, summary_of
from rr_opt.sysid.diagnosis import Diagnosis, Misfit, Remainder, Residue, Stage
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.remainder import Dependence, dependences

_CERTAIN = 1e-6
"""Chance of so large a gain by noise, below which a channel is told to be at fault."""


def diagnose_racer(
    racer: RollerRacer, progress: Callable[[str], None] = lambda _: None
) -> Diagnosis:
    """Diagnose a Roller Racer from its recordings.

    progress  is told each step
    """
    watch = Stopwatch(progress)
    result = identified(racer, watch)
    found = answer(result, watch)
    with watch("locating the fault"):
        first = _dependences(racer, result.selection.base.fit)
        found = _located(found, first, result)
    with watch("looking at what remains"):
        last = _dependences(racer, result.best.fit) if result.best.choices else first
        found = replace(
            found,
            remainder=_remainder(found, last),
            residue=_residue(last) if found.verdict == "unexplained" else (),
        )
    if found.verdict == "unexplained":
        found = _best_prediction(found, result)
    with watch("planning the next recording"):
        rival = rival_of(result)
        plan = next_experiment(racer, result.best.fit, rival and (rival[0], rival[1].fit))
    found = replace(found, next_experiment=plan, seconds=dict(watch.seconds))
    return replace(found, summary=summary_of(found, _worth(found)))


def _dependences(racer: RollerRacer, fit: Fit) -> list[Dependence]:
    return dependences(fit, *unknown_terms(racer, fit))


def _located(found: Diagnosis, tested: Sequence[Dependence], result: Result) -> Diagnosis:
    """With a stage for each channel: what an unknown input there would explain."""
    best = {
        channel: max((one for one in tested if one.channel == channel), key=lambda one: one.gain)
        for channel in CHANNELS
    }
    excess = result.selection.base.excess
    faulty = found.verdict in ("missing_physics", "unexplained")
    leading = max(best.values(), key=lambda one: one.gain)
    stages = tuple(
        Stage(
            channel.replace("_", " "),
            channel,
            one.gain,
            one.p_value,
            excess * float(np.sqrt(one.share)),
            faulty and one is leading and one.p_value < _CERTAIN,
            _where(one) if one.p_value < _CERTAIN else "",
            (one.curve,) if one.curve.at.size else (),
        )
        for channel, one in best.items()
    )
    where = _where(leading) if faulty and leading.p_value < _CERTAIN else ""
    channel = found.channel
    if found.verdict == "unexplained" and where:
        channel = leading.channel
    return replace(found, stages=stages, where=where, channel=channel)


def _where(one: Dependence) -> str:
    entry = {
        "rolling": "a force along the wheels",
        "yaw": "a moment that turns the robot",
        "constraint_axle1": "a side speed of axle 1",
        "constraint_axle2": "a side speed of axle 2",
        "actuation": "an error of the joint's angle",
    }[one.channel]
    if one.variable == CONSTANT:
        return f"{entry} that is constant"
    return f"{entry} that depends on {_article(one.variable)}"


def _article(variable: str) -> str:
    return variable if variable in ("time", "place") else f"the {variable}"


def _remainder(found: Diagnosis, left: Sequence[Dependence]) -> Remainder:
    remainder = found.remainder
    if remainder.size == "none":
        return replace(remainder, matters=_matters(found.final))
    depends = _where(left[0]) if left and left[0].p_value < _CERTAIN else ""
    return replace(remainder, depends_on=depends, matters=_matters(found.final))


def _worth(found: Diagnosis) -> str:
    return (
        f"the simulated place was {_placed(found.nominal):.1f} mm off (RMS beyond the noise) and "
        f"is {_placed(found.final):.1f} mm off now; "
    )


def _matters(misfits: Sequence[Misfit]) -> str:
    return f"The corrected simulation places the robot to within {_placed(misfits):.1f} mm (RMS)."


def _placed(misfits: Sequence[Misfit]) -> float:
    """RMS distance, mm, of the simulated from the recorded place, less the noise; of held-out
    recordings if there are any."""
    some = [one for one in misfits if one.held_out] or list(misfits)
    squares = []
    for one in some:
        with np.errstate(invalid="ignore", divide="ignore"):
            off = np.sum((one.predicted[:, :2] - one.recorded[:, :2]) ** 2, axis=1)
            squares.append(
                off - np.sum(np.broadcast_to(one.sigma, one.predicted.shape)[:, :2] ** 2, axis=1)
            )
    return 1e3 * float(np.sqrt(max(np.nanmean(np.concatenate(squares)), 0.0)))


def _residue(left: Sequence[Dependence]) -> tuple[Residue, ...]:
    """What is left as functions of what it depends on, the strongest first."""
    out = []
    shown = [each for each in left if each.p_value < _CERTAIN and each.curve.at.size]
    for one in shown[:2]:
        sentence = (
            f"What is left looks like {_where(one)}; that would explain {one.share:.0%} of it."
        )
        c = one.curve
        out.append(
            Residue(one.channel, c.variable, c.unit, c.at, c.mean, c.error, one.share, sentence)
        )
    return tuple(out)


def _best_prediction(found: Diagnosis, result: Result) -> Diagnosis:
    """The robot that predicts the held-out recordings best, though what it lacks has no name."""
    levels = (result.nominal, result.refitted, result.final)
    best = min(levels, key=lambda one: one.rms)
    fit = result.best.fit if best is result.final else result.selection.base.fit
    values = {**fit.values, **best.values}
    return replace(found, final=best.misfits, after=best.rms, values=values)
