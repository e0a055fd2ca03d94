"""The repeating solution of dv/dt = a v + b, with a and b sampled over a span.

With dA/dt = a less its mean, A periodic, exp(-A) is the integrating factor. Two ways on: one
exact for every harmonic, one that stays accurate however much A varies.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.verify.spectral import Spectrum, frequencies, harmonics, samples

Array = NDArray[np.float64]

_NEAR = (-2, -1, 0, 1, 2, 3)
"""Samples, counted from the start of a step, whose polynomial stands for the integrand."""


def _weights() -> Array:
    """Of the samples _NEAR in the integral over a step of length 1: exact for polynomials."""
    powers = np.arange(len(_NEAR))
    moments = np.array(_NEAR, float) ** powers[:, None]
    return np.asarray(np.linalg.solve(moments, 1 / (powers + 1.0)), float)


_WEIGHTS = _weights()


def solve(a: Array, b: Array, span: Array) -> tuple[Array, Array]:
    """v (n, K), and the mean of a (K,), harmonic by harmonic.

    y = v exp(-A) obeys dy/dt = mean y + b exp(-A), whose coefficient is constant: every
    harmonic of y is that of b exp(-A) over (i omega - mean).
    """
    omega = frequencies(len(a), span)
    A, mean = _exponent(a, omega)
    growth = np.exp(A)
    forcing = harmonics(b / growth)
    forcing /= omega - mean
    return growth * samples(forcing, len(a)), mean


def solve_stiff(a: Array, b: Array, span: Array) -> tuple[Array, Array]:
    """v (n, K), and the mean of a (K,), for an a that dry friction makes large and sudden.

    exp(A) may then span more orders of magnitude than a float has digits, but over one step it
    does not. So each step from sample to sample becomes a map v -> gain v + shift, with the
    integral in it of order six; the maps of 1, 2, 4 .. n steps from every sample follow by
    joining pairs, and the last of them close the cycle. n is a power of two.
    """
    n, h = len(a), span / len(a)
    A, mean = _exponent(a, frequencies(n, span))
    # Clipped: where a step is stiffer, v is only as good as the samples are dense.
    gain = np.exp(np.clip(np.roll(A, -1, axis=0) - A + mean * h, -10.0, 1.0))
    # exp of what a gathers from each near sample to the end of the step, one gain at a time.
    next1, next2, last1, last2 = (np.roll(gain, k, axis=0) for k in (-1, -2, 1, 2))
    factors = (gain * last1 * last2, gain * last1, gain, 1.0, 1 / next1, 1 / (next1 * next2))
    shift = np.zeros_like(a)
    for k, weight, factor in zip(_NEAR, _WEIGHTS, factors, strict=True):
        shift += weight * factor * np.roll(b, -k, axis=0)
    shift *= h
    steps = 1
    while steps < n:
        later = np.roll(gain, -steps, axis=0)
        shift = later * shift + np.roll(shift, -steps, axis=0)
        gain = later * gain
        steps *= 2
    return shift / (1 - gain), mean


def _exponent(a: Array, omega: Spectrum) -> tuple[Array, Array]:
    """A (n, K) and the mean of a (K,)."""
    spectrum = harmonics(a)
    mean = spectrum[0].real / len(a)
    spectrum[0] = 0.0
    spectrum[1:] /= omega[1:]
    return samples(spectrum, len(a)), mean
