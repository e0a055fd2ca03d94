"""The servo's own log: goal and present position in counts, on its own clock."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rr_opt.experiment.count_scale import CountScale
from rr_opt.lab.drive import servo_angles
from rr_opt.lab.outing import Outing
from rr_opt.lab.rig import Rig
from rr_opt.robot.gait import Gait

RATE = 250.0
"""1/s, of the servo's own clock."""


@dataclass(frozen=True)
class ServoClock:
    """The log's time is (command time - offset) (1 + drift); offset in s."""

    offset: float = 0.0
    drift: float = 0.0


def drawn_clock(rng: np.random.Generator) -> ServoClock:
    """Up to half a second and 0.1 per mille off."""
    return ServoClock(float(rng.uniform(-0.5, 0.5)), float(rng.uniform(-1e-4, 1e-4)))


def log_text(rig: Rig, gait: Gait, outing: Outing, clock: ServoClock) -> str:
    """CSV `t,goal,present` of one run, from the log's t = 0.

    `present` is the angle of the servo's own shaft: play behind it does not show.
    """
    own = np.arange(round(outing.seconds * RATE) + 1) / RATE
    goal, present = servo_angles(rig, gait, outing, own / (1 + clock.drift) + clock.offset)
    scale = CountScale()
    counts = (np.rint(scale.zero + angle / scale.each).astype(int) for angle in (goal, present))
    rows = (f"{t:.3f},{one},{two}" for t, one, two in zip(own, *counts, strict=True))
    return "t,goal,present\n" + "\n".join(rows) + "\n"
