"""The noise of recordings, estimated from the data: its level and its correlation in time.

Capture systems state the level of white noise. Filters, frame-to-frame tracking of markers and
wrong data sheets change it, and what counts for slow motion is the spectrum at low frequencies:
correlated samples carry less information.

The residuals of a fit contain noise and model error. Model error is slow or repeats with the gait,
and so occupies a few lines of the spectrum. The noise spectrum is therefore estimated by medians
over neighbouring frequencies and over runs, which lines do not affect, and extrapolated to low
frequencies as that of an exponentially correlated process, 1/S = (1 + f^2/f0^2)/S0.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rr_opt.array import Array
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.model import ChannelNoise
from rr_opt.sysid.settings import SETTINGS

_BINS = 48
"""Frequency bins above the slow band, logarithmically spaced."""

_NEAR = 3.0
"""The spectrum is extrapolated from frequencies up to this many times the slow band's edge."""


def noise_in(fit: Fit) -> list[ChannelNoise] | None:
    """Noise of each channel, from the residuals of a fit of whole runs, as seams between segments
    would look like noise; None if it is as assumed."""
    problem = fit.problem
    channels = len(problem.model.channels)
    # Correlation is a property of the channels, the same in every run.
    assumed = np.broadcast_to(next(iter(problem.model.runs)).correlation, channels)
    runs = {
        run: np.concatenate(
            [fit.linear.made[one].residuals[: one.until - one.first] for one in parts]
        )
        * np.sqrt(assumed)
        for run, parts in problem.by_run.items()
    }
    steps = [float(np.median(np.diff(problem.model.runs[run].t))) for run in runs]
    slow = problem.model.bandwidth
    noise = [
        levelled([left[:, k] for left in runs.values()], steps, slow, assumed[k])
        for k in range(channels)
    ]
    differs = any(one.differs(c) for one, c in zip(noise, assumed.tolist(), strict=True))
    return noise if differs else None


def levelled(
    residuals: Sequence[Array], steps: Sequence[float], slow: float, assumed: float
) -> ChannelNoise:
    """The noise in residuals, as `noise_of` takes them: as assumed unless the spectrum contradicts
    it, or model error would pass for noise. If it does, the level is their RMS where the spectral
    estimate is close to that.

    assumed  their correlation
    """
    noise = noise_of(residuals, steps, slow)
    if not noise.differs(assumed):
        return ChannelNoise(correlation=assumed)
    every = np.concatenate(residuals)
    rms = float(np.sqrt(np.mean(every[every != 0] ** 2))) if every.any() else noise.level
    near = abs(math.log(rms / noise.level)) < SETTINGS.misstated
    return replace(noise, level=rms) if near else noise


def noise_of(
    residuals: Sequence[Array], steps: Sequence[float], slowest: float = SETTINGS.slow
) -> ChannelNoise:
    """The noise in residuals (n,) of runs, in the units stated, 0 where there are no data.

    steps    between the samples of each, s
    slowest  Hz; anything slower may be the machine's motion
    """
    fastest = 0.5 / max(steps)
    if fastest < _NEAR * slowest:
        return ChannelNoise()
    edges = np.geomspace(slowest, fastest, _BINS + 1)
    density: list[list[float]] = [[] for _ in range(_BINS)]
    for r, step in zip(residuals, steps, strict=True):
        window = np.hanning(r.size) * (r != 0)
        weight = float(window @ window)
        if weight <= 0:
            continue
        power = np.abs(np.fft.rfft(window * r)) ** 2 / weight
        at = np.digitize(np.fft.rfftfreq(r.size, step), edges) - 1
        for k in np.unique(at[(at >= 0) & (at < _BINS)]):
            # Mean power from the median of an exponential distribution, also of few values.
            few = power[at == k]
            density[k].append(float(np.median(few)) / _median(few.size))
    seen = np.array([np.median(one) if one else np.nan for one in density])
    middle, width = np.sqrt(edges[1:] * edges[:-1]), np.diff(edges)
    known = np.isfinite(seen)
    if known.sum() < _BINS // 2:
        return ChannelNoise()
    near = known & (middle < _NEAR * slowest)
    edge = float(np.median(seen[near]))
    through = np.polyfit(middle[near] ** 2, edge / seen[near], 1)[1]
    slow = edge / float(np.clip(through, 0.5, 1.0))
    total = slow * slowest + float(np.sum((seen * width)[known])) / known.mean()
    variance = total / fastest
    return ChannelNoise(math.sqrt(variance), max(slow / variance, 1.0))


def _median(n: int) -> float:
    """Expected median of n exponentially distributed values with mean 1."""
    return (
        float(np.sum(1 / np.arange((n + 1) // 2, n + 1)))
        if n % 2
        else ((_median(n - 1) + _median(n + 1)) / 2 if n > 2 else 1.0)
    )
