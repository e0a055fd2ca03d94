"""What bends: the platforms half way to their axles, and what holds a shifting load."""

from __future__ import annotations

from rr_opt.lab.planar.moment import Moment, Pull, spring
from rr_opt.lab.rig import Rig

SLACKENS = 2e-3
"""s, in which a bent platform straightens: its axle has no mass of its own, so a damper alone says
how fast."""

RINGS = 0.1
"""A shifting load's damper over its spring and mass, c/sqrt(k m): it swings some ten times."""


def bent(moment: Moment, rig: Rig) -> list[Pull]:
    """All that the rig has."""
    pulls = []
    if rig.spring is not None:
        for name in ("bend1", "bend2"):
            angle = moment.layout.of(name)
            pulls.append(spring(moment, angle, rig.spring, SLACKENS * rig.spring))
    if rig.load is not None:
        mass, stiffness = rig.load
        damping = RINGS * (mass * stiffness) ** 0.5
        pulls.append(spring(moment, moment.layout.of("shift"), stiffness, damping))
    return pulls
