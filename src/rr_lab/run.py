"""A run: the robot released with a gait, its observation by a capture system, and the recording."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rr_lab.disturbances import NO_DISTURBANCE, Disturbance
from rr_lab.rig import Rig
from rr_opt.array import Array
from rr_opt.model.experiment import Flag, Noise, Recording
from rr_opt.model.gait import Gait


@dataclass(frozen=True)
class Conditions:
    """Conditions of a run: how a robot is released, and what is recorded.

    seconds, rate   length of the recording, s, and sample rate, 1/s
    start           `rest`: the command begins at its time 0; `running`: `periods` whole periods
                    before, from rest
    nudge           m/s, change of speed of the whole mass by a push at the recording's t = 0
    torque          whether the servo's torque is recorded too
    pose            x (m), y (m) of P and heading (rad) of platform 1 at the start
    """

    seconds: float
    start: Literal["rest", "running"] = "rest"
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rate: float = 100.0
    periods: int = 3
    nudge: float = 0.0
    torque: bool = False

    def begin(self, gait: Gait) -> float:
        """Start of the command, s on its own clock."""
        return 0.0 if self.start == "rest" else -self.periods * gait.period


@dataclass(frozen=True)
class Motion:
    """The true motion, at the recording's times t (n,), s.

    one, two  x (m), y (m) and heading (rad, unwrapped) of the platforms' joint ends, (n, 3). A
              loose pin sets them apart
    torque    of the servo on platform 2, N m (n,), if requested
    """

    t: Array
    one: Array
    two: Array
    torque: Array | None = None


def asked_angle(rig: Rig, gait: Gait, begin: float, t: NDArray[Any]) -> Array:
    """The angle that the servo is to make, rad, at the times t: the command, shaped by its faults.

    begin  start of the command, s; before it the servo holds its first angle
    """
    angle = gait.angle(np.maximum(t, begin)) + rig.offset
    for shaper in rig.shapers:
        angle = shaper(t, angle)
    return angle


def captured(
    motion: Motion,
    name: str,
    noise: Noise,
    rng: np.random.Generator,
    *,
    tracked: Sequence[float] = (0.0, 0.0),
    missing: float = 0.0,
    disturbance: Disturbance = NO_DISTURBANCE,
) -> Recording:
    """The recording of a motion; with the torque if available.

    noise        1 sigma as stated in the experiment
    tracked      the point that is taken for the joint, m, in platform 1's frame
    missing      fraction of lost samples, all channels at once
    disturbance  further disturbance
    """
    x, y, psi = motion.one.T
    phi = motion.two[:, 2] - psi
    dx, dy = tracked
    true = {
        "x": x + dx * np.cos(psi) - dy * np.sin(psi),
        "y": y + dx * np.sin(psi) + dy * np.cos(psi),
        "psi": psi,
        # The two headings are unwrapped separately, and may differ by whole turns.
        "phi": phi - 2 * np.pi * np.round(phi[0] / (2 * np.pi)),
    }
    if motion.torque is not None:
        true["torque"] = motion.torque
    n, t = len(motion.t), disturbance.clock * motion.t
    rate = 1 / (t[1] - t[0])
    lost = rng.random(n) < missing
    stated = {channel: np.full(n, noise.of(channel)) for channel in true}
    seen = {
        channel: exact + stated[channel] / disturbance.stated * disturbance.noise(rng, n)
        for channel, exact in true.items()
    }
    kept = disturbance.distort(seen, stated, rate, rng)
    values = {channel: np.where(lost, np.nan, each) for channel, each in kept.items()}
    flags = {
        channel: np.where(np.isnan(each), np.uint8(Flag.MISSING), np.uint8(0))
        for channel, each in values.items()
    }
    source = {"laboratory": "virtual", "rate": f"{rate:g} Hz"}
    return Recording(name, t, values, stated, flags, source)
