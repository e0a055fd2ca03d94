"""Disturbances between a motion and its recording, beyond white noise of the stated size.

None of them is physics: the right diagnosis of a disturbed recording is that of an undisturbed one.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.outcome import InputError

Channels = Mapping[str, Array]
Distortion = Callable[[Channels, Channels, float, np.random.Generator], Channels]
"""(values, sigma of each channel, samples a second, random numbers) -> recorded values."""


@dataclass(frozen=True)
class Disturbance:
    """noise      of unit variance, of n samples
    distort    distortion of the noisy channels
    clock      seconds of the recording's clock per true second
    stated     ratio of the noise stated in the experiment to the true one
    """

    name: str
    what: str
    noise: Callable[[np.random.Generator, int], Array] = np.random.Generator.standard_normal
    distort: Distortion = lambda values, *_: values
    clock: float = 1.0
    stated: float = 1.0


NO_DISTURBANCE = Disturbance("", "white noise of the stated size")


def _low_pass(cutoff: float) -> Distortion:
    """Butterworth, second order, forwards and backwards, as in motion capture software."""

    def smooth(values: Channels, _sigma: Channels, rate: float, _: np.random.Generator) -> Channels:
        from scipy.signal import butter, sosfiltfilt  # slow to import

        sections = butter(2, cutoff, fs=rate, output="sos")
        return {name: np.asarray(sosfiltfilt(sections, each)) for name, each in values.items()}

    return smooth


CORRELATION = 0.8
"""Correlation of successive samples of coloured noise."""


def _coloured(rng: np.random.Generator, n: int) -> Array:
    """AR(1) noise of unit variance."""
    from scipy.signal import lfilter  # slow to import

    steps = np.sqrt(1 - CORRELATION**2) * rng.standard_normal(n)
    first = CORRELATION * rng.standard_normal()
    return np.asarray(lfilter([1.0], [1.0, -CORRELATION], steps, zi=[first])[0])


OUTLIERS, FAR = 0.02, (10.0, 60.0)
"""The share of outlier samples, and their size in sigma."""


def _wild(values: Channels, sigma: Channels, _rate: float, rng: np.random.Generator) -> Channels:
    """An outlier affects all channels, as when a marker is mistaken."""
    n = len(next(iter(values.values())))
    wild = rng.random(n) < OUTLIERS
    return {
        name: each + wild * sigma[name] * rng.uniform(*FAR, n) * rng.choice([-1, 1], n)
        for name, each in values.items()
    }


LOST, GAP = 0.2, 0.1
"""The share of samples that are lost, and the mean length of a gap, s."""


def _gaps(values: Channels, _sigma: Channels, rate: float, rng: np.random.Generator) -> Channels:
    """Samples lost in gaps: a Markov chain."""
    ends = 1 / (GAP * rate)
    begins = ends * LOST / (1 - LOST)
    n = len(next(iter(values.values())))
    chance, lost = rng.random(n), np.empty(n, bool)
    state = bool(rng.random() < LOST)
    for k in range(n):
        state = chance[k] >= ends if state else chance[k] < begins
        lost[k] = state
    return {name: np.where(lost, np.nan, each) for name, each in values.items()}


EVERY, LONG, BESIDE = 4.0, (0.1, 0.3), 0.15
"""s: mean interval between swaps, their length, and how much on either side repairs them."""


def _mended(values: Channels, _sigma: Channels, rate: float, rng: np.random.Generator) -> Channels:
    """Swapped markers, repaired by a cubic through the samples on either side."""
    made = {name: each.copy() for name, each in values.items()}
    n, beside = len(next(iter(values.values()))), round(BESIDE * rate)
    for _ in range(round(n / rate / EVERY)):
        size = round(rng.uniform(*LONG) * rate)
        start = int(rng.integers(beside, max(beside + 1, n - size - beside)))
        gap = np.arange(start, min(start + size, n))
        near = np.concatenate([gap[0] - 1 - np.arange(beside), gap[-1] + 1 + np.arange(beside)])
        near = near[(near >= 0) & (near < n)]
        for each in made.values():
            each[gap] = np.polynomial.Polynomial.fit(near, each[near], 3)(gap)
    return made


COARSE_ANGLE = 3e-3
"""Step of coarse angles, rad."""


def _coarse(values: Channels, _sigma: Channels, _rate: float, _: np.random.Generator) -> Channels:
    return {
        name: COARSE_ANGLE * np.rint(each / COARSE_ANGLE) if name in ("psi", "phi") else each
        for name, each in values.items()
    }


DISTURBANCES = {
    each.name: each
    for each in (
        Disturbance("lowpass_10hz", "low-pass filtered at 10 Hz", distort=_low_pass(10.0)),
        Disturbance("lowpass_6hz", "low-pass filtered at 6 Hz", distort=_low_pass(6.0)),
        Disturbance(
            "ar1_noise", "noise with a sample-to-sample correlation of 0.8", noise=_coloured
        ),
        Disturbance("outliers", "2 % of the samples are outliers", distort=_wild),
        Disturbance("dropouts", "20 % of the samples are missing, in gaps", distort=_gaps),
        Disturbance("mended_swaps", "swapped markers were repaired with a cubic", distort=_mended),
        Disturbance("coarse_angles", "angles in steps of 3 mrad", distort=_coarse),
        Disturbance("clock_drift", "the recording's clock is 1 % fast", clock=1.01),
        Disturbance("noise_understated", "the stated noise is half the true noise", stated=0.5),
        Disturbance("noise_overstated", "the stated noise is twice the true noise", stated=2.0),
    )
}


def disturbance_named(name: str) -> Disturbance:
    """The disturbance of a name, none for an empty one; raises InputError if there is none such."""
    if name and name not in DISTURBANCES:
        raise InputError(
            f"The laboratory has no disturbance {name!r}. Expected one of: "
            f"{', '.join(DISTURBANCES)}. Correct the name."
        )
    return DISTURBANCES[name] if name else NO_DISTURBANCE
