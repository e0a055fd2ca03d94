"""Whether what an alternative claims is so, and is the best: by the project's own replay."""

from __future__ import annotations

from dataclasses import dataclass, replace

from benchmarks.optimise.peers.posed import Claim, Posed
from rr_opt.model.gait import SineGait
from rr_opt.outcome import NotConvergedError
from rr_opt.verify.replay import replay

REACHED = 1e-4
"""A speed no more than this short of the best known, relative, is the best."""
HONEST = 1e-4
"""A claimed speed that differs less from the replayed one is true."""
KEPT = 1e-3
"""An excess over a limit, relative, up to which it counts as kept: an alternative holds the torque
at some hundred phases, and a peak lies between two of them."""


@dataclass(frozen=True)
class Judged:
    """gap: replayed speed against the best known, relative, negative if slower; error: of the
    claim; excess: over the worst limit; right: the best known gait, and its solver says so."""

    gap: float
    error: float
    excess: float
    right: bool
    why: str


def judged(posed: Posed, claim: Claim, best: float) -> Judged:
    """Replay a claim by CVODES. `best` is the best known speed, m/s."""
    two = replace(posed.robot.platform2, I=claim.inertia)
    gait = SineGait(claim.amplitude, claim.period, claim.offset)
    try:
        seen = replay(replace(posed.robot, platform2=two), gait, posed.problem.limits, claim.speed)
    except (NotConvergedError, ZeroDivisionError):
        return Judged(-1.0, 1.0, 1.0, False, "no steady motion")
    gap = abs(seen.speed) / abs(best) - 1
    error = abs(abs(claim.speed) - abs(seen.speed)) / abs(seen.speed)
    why = ""
    if not claim.solved:
        why = "not solved"
    elif gap < -REACHED:
        why = "another optimum"
    elif error > HONEST:
        why = "another speed"
    elif seen.excess > KEPT:
        why = "limit broken"
    return Judged(gap, error, seen.excess, not why, why)
