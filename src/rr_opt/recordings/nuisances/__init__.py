"""The catalogue of nuisances: what goes wrong between a motion and its recording, by name.

A nuisance is a `look` in a module here, a function from an ExaminedRecording to notices. Rolling
wheels tie place, heading and joint angle together at every instant, whatever the forces are, and
the command ties the angle to the clock. So a nuisance shows in the kinematics, and an effect of the
robot's physics, which obeys these constraints or nearly so, is not mistaken for one.
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
"""Run in this order until one finds a problem that makes the others meaningless."""


def nuisances(evidence: ExaminedRecording) -> tuple[Notice, ...]:
    """All notices on a recording of a moving robot."""
    found: list[Notice] = []
    for look in CATALOGUE:
        found += look(evidence)
        if any(one.level == "error" or one.kind == "useless" for one in found):
            break
    return tuple(found)
