"""The diagnosis of a Roller Racer: the engine's answer, and what only this machine can tell.

Where along the way from the command to the floor the fault sits, which names these recordings
cannot tell apart, what to record next, and, where no name fits, what the missing force is like.
"""

from __future__ import annotations

from dataclasses import replace

from rr_opt.machines.racer.next_experiment import next_experiment
from rr_opt.machines.racer.racer import RollerRacer, zeroed
from rr_opt.machines.racer.residual import residue, systematic
from rr_opt.machines.racer.stages.stages import located, stages
from rr_opt.sysid.diagnose import Found, Steps, answer, found, held_out_alone, summary_of
from rr_opt.sysid.diagnosis import Diagnosis
from rr_opt.sysid.evaluation import Level, level_of
from rr_opt.sysid.indistinguishable import groups
from rr_opt.sysid.values import estimates


def diagnose_racer(racer: RollerRacer, steps: Steps | None = None) -> Diagnosis:
    """Diagnose a Roller Racer from its recordings."""
    it = found(racer, steps or Steps())
    said = answer(it)
    if said.verdict == "missing_physics" and it.steps.timed(
        "is that all", lambda: systematic(racer, it.best, it.search.base, it.steps.each)
    ):
        said = answer(it, systematic=True)
    tested = it.steps.timed(
        "where", lambda: stages(zeroed(racer, it.search.base.whole), it.search.base.whole)
    )
    said = located(said, tested, racer.catalogue)
    said = _told_apart(racer, it, said)
    if said.verdict == "unexplained":
        search, each = it.search, it.steps.each
        left = it.steps.timed(
            "what is left", lambda: residue(racer, search.base, each, by_speed=search.nameless_does)
        )
        said = it.steps.timed("without a name", lambda: _nameless(racer, it, said))
        said = replace(said, residue=left)
    return replace(said, seconds=dict(it.steps.seconds))


def _nameless(racer: RollerRacer, it: Found, said: Diagnosis) -> Diagnosis:
    """The robot that predicts the held-out recordings best, though what it lacks has no name.

    It is the robot as believed, or has other parameters: alone, with a force over speed beside
    them, or with the effects that came nearest.
    """
    start = it.levels[0].fit
    search = it.search
    curved = [level_of(racer, fit, start) for fit in [search.nameless] if fit]
    best = min((*it.levels[:2], *curved, it.levels[2]), key=Level.held)
    values = dict(best.fit.values)
    intervals = estimates(racer, best.fit, best.surplus())
    return replace(
        said,
        final=best.misfits,
        after=best.unseen(),
        values=values,
        parameters={q.name: intervals[q.name] for q in best.fit.quantities},
        summary=summary_of(said.verdict, (), it.levels[0], best, apart=held_out_alone(it)),
    )


def _told_apart(racer: RollerRacer, it: Found, said: Diagnosis) -> Diagnosis:
    if said.verdict in ("missing_physics", "parameters"):
        alike = it.steps.timed("what is alike", lambda: groups(it.search, it.best))
        said = replace(said, indistinguishable=alike)
    rival = it.rivals[0] if it.rivals else None
    plan = it.steps.timed("what to record next", lambda: next_experiment(racer, it.best, rival))
    return replace(said, next_experiment=plan)
