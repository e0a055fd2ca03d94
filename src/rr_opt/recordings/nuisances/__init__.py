"""The catalogue of nuisances: what goes wrong between a motion and its recording, by name.

A nuisance is a `look` in a module here, a function from the Evidence of a recording to notices.
Wheels that roll tie place, heading and joint angle together at every instant, whatever the
forces are, and the command ties the angle to the clock. So a nuisance shows in the kinematics, and
an effect of the robot's physics, which obeys them or nearly so, does not pass for one.
"""

from rr_opt.recordings.nuisances import command, frame, plausible, push, start
from rr_opt.recordings.nuisances.evidence import ExaminedRecording, Look
from rr_opt.recordings.warnings import Notice

CATALOGUE: tuple[Look, ...] = (
    plausible.look,
    plausible.look_at_units,
    command.look_at_clock,
    frame.look,
    frame.look_at_delays,
    frame.look_twice,
    command.look,
    push.look,
    start.look,
)
"""Asked in this order until one finds what makes the others mean nothing."""


def nuisances(evidence: ExaminedRecording) -> tuple[Notice, ...]:
    """What is found in a recording that moves."""
    found: list[Notice] = []
    for look in CATALOGUE:
        found += look(evidence)
        if any(one.level == "error" or one.kind == "useless" for one in found):
            break
    return tuple(found)
