"""How a robot is let go with a gait, and what is written down of it, whatever drives it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rr_opt.lab.rig import Rig
from rr_opt.robot.gait import Gait

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Outing:
    """How a robot is let go.

    seconds, rate   how long is recorded, s, and how often, 1/s
    start           `rest`: the command begins at its time 0; `running`: `periods` whole periods
                    before, from rest
    nudge           m/s, a push at the recording's t = 0, by which the whole mass would be faster
    torque          whether the servo's is written down too
    pose            x (m), y (m) of P and heading (rad) of platform 1 where it is put down
    """

    seconds: float
    start: Literal["rest", "running"] = "rest"
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rate: float = 100.0
    periods: int = 3
    nudge: float = 0.0
    torque: bool = False

    def begin(self, gait: Gait) -> float:
        """When the command begins, s on its own clock."""
        return 0.0 if self.start == "rest" else -self.periods * gait.period


@dataclass(frozen=True)
class Motion:
    """What truly happened, at the recording's times t (n,), s.

    one, two  x (m), y (m) and heading (rad, unwrapped) of the platforms' joint ends, (n, 3). A
              loose pin sets them apart
    torque    of the servo on platform 2, N m (n,), if it was asked for
    """

    t: Array
    one: Array
    two: Array
    torque: Array | None = None


def asked_angle(rig: Rig, gait: Gait, begin: float, t: NDArray[Any]) -> Array:
    """The angle that the servo is to make, rad, at the times t: the command, shaped by its faults.

    begin  when the command begins, s; before it the servo holds its first angle
    """
    angle = gait.angle(np.maximum(t, begin)) + rig.offset
    for shaper in rig.shapers:
        angle = shaper(t, angle)
    return angle
