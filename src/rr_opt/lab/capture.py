"""What the capture system makes of a motion: its point, its noise, its gaps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.experiment import Noise
from rr_opt.experiment.recording import Flag, Recording
from rr_opt.lab.outing import Motion

Array = NDArray[np.float64]


def captured(
    motion: Motion,
    name: str,
    noise: Noise,
    rng: np.random.Generator,
    *,
    tracked: tuple[float, float] = (0.0, 0.0),
    missing: float = 0.0,
) -> Recording:
    """A motion as it is recorded, with white noise; with the torque if it was written down.

    tracked  the point that is taken for the joint, m, in platform 1's frame
    missing  fraction of the samples that are lost, all channels at once
    """
    x, y, psi = motion.one.T
    phi = motion.two[:, 2] - psi
    dx, dy = tracked
    true = {
        "x": x + dx * np.cos(psi) - dy * np.sin(psi),
        "y": y + dx * np.sin(psi) + dy * np.cos(psi),
        "psi": psi,
        # The two headings are unwrapped apart, and may differ by whole turns.
        "phi": phi - 2 * np.pi * np.round(phi[0] / (2 * np.pi)),
    }
    if motion.torque is not None:
        true["torque"] = motion.torque
    n = len(motion.t)
    lost = rng.random(n) < missing
    values, sigma, flags = {}, {}, {}
    for channel, exact in true.items():
        size = noise.of(channel)
        values[channel] = np.where(lost, np.nan, exact + size * rng.standard_normal(n))
        sigma[channel] = np.full(n, size)
        flags[channel] = np.where(lost, np.uint8(Flag.MISSING), np.uint8(0))
    source = {"laboratory": "virtual", "rate": f"{1 / (motion.t[1] - motion.t[0]):g} Hz"}
    return Recording(name, motion.t, values, sigma, flags, source)
