"""Calculus on samples of periodic functions by Fourier series, many functions at once.

Samples x (n, K): n equal steps along the first axis, over one `span` (K,), s, of K functions.
A span is what a function repeats after. Over half a period of a straight gait some functions
repeat and some change sign; the latter are `flipping` and repeat after two spans.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft

Array = NDArray[np.float64]
_Operation = Callable[[Array, bool], Array]

FINER = 4
"""How many times denser `resampled` is."""

_DENSE = 64
"""Up to so many samples one matrix product is faster than the transforms it stands for."""


def solve_linear(a: Array, b: Array, span: Array) -> tuple[Array, Array]:
    """The repeating solution v (n, K) of dv/dt = a v + b, and the mean of a (K,).

    With a = mean + dA/dt and A periodic, y = v exp(-A) obeys dy/dt = mean y + b exp(-A), whose
    coefficient is constant: every harmonic of y is that of b exp(-A) over (i omega - mean).
    """
    n = len(a)
    omega = _frequencies(n, span)
    spectrum = rfft(a, axis=0)
    mean = spectrum[0].real / n
    spectrum[0] = 0.0
    spectrum[1:] /= omega[1:]
    growth = np.exp(irfft(spectrum, n, axis=0))
    forcing = rfft(b / growth, axis=0)
    forcing /= omega - mean
    return growth * irfft(forcing, n, axis=0), mean


def derivative(x: Array, span: Array) -> Array:
    """dx/dt (n, K) of functions that repeat after the span; n is even."""
    spectrum = rfft(x, axis=0) * _frequencies(len(x), span)
    spectrum[-1] = 0.0
    return irfft(spectrum, len(x), axis=0)


def integral(x: Array, span: Array, flipping: bool) -> Array:
    """The periodic integral (n, K) of x less its mean; its own mean is zero."""
    return span * _apply(_integral, x, flipping)


def resampled(x: Array, flipping: bool) -> Array:
    """x at FINER n points, (FINER n, K): the spectrum padded with zeros."""
    return _apply(_resampled, x, flipping)


def tail(x: Array, flipping: bool) -> Array:
    """Size of the fastest eighth of the harmonics, (K,), in the unit of x."""
    return np.abs(_apply(_tail, x, flipping)).max(axis=0)


def _frequencies(n: int, span: Array) -> NDArray[np.complex128]:
    return 2j * np.pi / span * np.arange(n // 2 + 1)[:, None]


def _apply(operation: _Operation, x: Array, flipping: bool) -> Array:
    if len(x) <= _DENSE:
        return _matrix(operation, len(x), flipping) @ x
    return operation(x, flipping)


@lru_cache
def _matrix(operation: _Operation, n: int, flipping: bool) -> Array:
    return operation(np.eye(n), flipping)


def _repeating(x: Array, flipping: bool) -> Array:
    return np.concatenate([x, -x]) if flipping else x


def _integral(x: Array, flipping: bool) -> Array:
    whole = _repeating(x, flipping)
    spectrum = rfft(whole, axis=0)
    spectrum[0] = 0.0
    spectrum[1:] /= 2j * np.pi * np.arange(1, len(spectrum))[:, None] * len(x) / len(whole)
    return irfft(spectrum, len(whole), axis=0)[: len(x)]


def _resampled(x: Array, flipping: bool) -> Array:
    whole = _repeating(x, flipping)
    dense = irfft(rfft(whole, axis=0), FINER * len(whole), axis=0) * FINER
    return dense[: FINER * len(x)]


def _tail(x: Array, flipping: bool) -> Array:
    whole = _repeating(x, flipping)
    spectrum = rfft(whole, axis=0) * (2 / len(whole))
    top = spectrum[-1 - len(spectrum) // 8 : -1]
    return np.concatenate([top.real, top.imag])
