"""The recording that would tell best between what is still open.

That is the accepted explanation and its closest rival; where there is none, the value that is known
worst. Gaits are ranked first, then starts and headings of the best of them, all linearised, and the
winner is checked by simulation.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

from rr_opt.diagnose.contest import Contest, Rival, as_rival, name_of
from rr_opt.diagnose.diagnosis import NextExperiment
from rr_opt.diagnose.explanation import Explanation
from rr_opt.diagnose.plans import Plan, extent, gaits
from rr_opt.diagnose.racer import RollerRacer
from rr_opt.diagnose.worst_known import Narrowing

_SHORT, _LONG = 30.0, 60.0
_HEADINGS = tuple(k * math.pi / 2 for k in range(4))
_FINALISTS = 3
_TRIED = 48
"""So many gaits, spread over those that are allowed."""

_CLEAR = 1.0
"""A recording that tells the two apart by so much, RMS in sigma, is long enough."""

_ROOM = 1.5
"""So much farther than the present recordings, the next may go."""


Promises = Callable[[Sequence[Plan]], Sequence[float]]


def next_experiment(
    model: RollerRacer, best: Explanation, rival: Explanation | None = None
) -> NextExperiment | None:
    """The plan that tells best; None if no gait is allowed or none tells anything.

    rival  another explanation; without one, the value that is known worst is to be known better
    """
    room = _ROOM * extent([data.values[:, :2] for data in model.runs])
    if rival is None:
        narrowing = Narrowing(model, best, room)
        plan = _leading(narrowing.promises, model)
        other = narrowing.rival(plan) if plan else None
    else:
        other = as_rival(rival)
        plan = _leading(Contest(model, best, other, room).promises, model)
    if plan is None or other is None:
        return None
    return _checked(Contest(model, best, other, room), plan, other, name_of(best))


def _leading(promises: Promises, model: RollerRacer) -> Plan | None:
    """The plan that promises most: gaits first, then starts and headings of the best."""
    allowed = gaits(model.experiment.robot)
    some = allowed[:: max(len(allowed) // _TRIED, 1)]
    first = _ranked(promises, [Plan(gait, _SHORT, "rest", 0.0) for gait in some])[:_FINALISTS]
    varied = [
        replace(plan, start=start, heading=heading)
        for plan in first
        for start in ("rest", "running")
        for heading in _HEADINGS
    ]
    return next(iter(_ranked(promises, varied)), None)


def _ranked(promises: Promises, plans: Sequence[Plan]) -> list[Plan]:
    """Those that promise anything, most first."""
    if not plans:
        return []
    found = sorted(zip(promises(plans), range(0, -len(plans), -1), strict=True), reverse=True)
    return [plans[-k] for promised, k in found if promised > 0]


def _checked(contest: Contest, plan: Plan, other: Rival, name: str) -> NextExperiment:
    told = contest.checked(plan)
    longer = replace(plan, seconds=_LONG)
    if told < _CLEAR and contest.promises([longer])[0] > 0:
        plan, told = longer, contest.checked(longer)
    return _told(plan, (name, other.name), told, other.tells)


def _told(plan: Plan, between: tuple[str, str], told: float, tells: str) -> NextExperiment:
    gait, degrees = plan.gait, math.degrees
    begin = "from standing still" if plan.start == "rest" else "while it is running"
    tells = tells or (
        f"There {between[0]} and {between[1]} should differ by {told:.2g} sigma, RMS, after both "
        "are fitted to all recordings."
    )
    sentence = (
        f"Record {plan.seconds:.0f} s {begin}, heading {degrees(plan.heading):.0f} deg, with "
        f"amplitude {gait.amplitude:g} rad ({degrees(gait.amplitude):.0f} deg), period "
        f"{gait.period:g} s and offset {gait.offset:g} rad ({degrees(gait.offset):.0f} deg). "
        f"{tells}"
    )
    return NextExperiment(
        gait.amplitude,
        gait.period,
        gait.offset,
        plan.seconds,
        plan.start,
        plan.heading,
        between,
        told,
        sentence,
    )
