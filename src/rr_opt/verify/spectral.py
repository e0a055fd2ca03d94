"""Calculus on samples of periodic functions by Fourier series, many functions at once.

Samples x (n, K): n equal steps (n even) along the first axis, over one `span` (K,), s, of K
functions. A span is what a function repeats after. Over half a period of a straight gait some
functions repeat and some change sign; the latter are `flipping` and repeat after two spans.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.fft import irfft, rfft
from numpy.typing import NDArray

Array = NDArray[np.float64]
Spectrum = NDArray[np.complex128]
_Operation = Callable[[Array, bool], Array]

_DENSE = 64
"""Up to so many samples one matrix product is faster than the transforms it stands for."""

_SMOOTH = 256
"""At least so many samples show a peak well enough for a parabola."""


def harmonics(x: Array) -> Spectrum:
    """The spectrum (n/2 + 1, K) of x: its mean times n, then what goes with each frequency."""
    return np.asarray(rfft(x, axis=0))


def samples(spectrum: Spectrum, n: int) -> Array:
    """The n samples (n, K) that have this spectrum."""
    return np.asarray(irfft(spectrum, n, axis=0))


def frequencies(n: int, span: Array) -> Spectrum:
    """i omega of the harmonics of n samples, (n/2 + 1, K), rad/s."""
    return np.arange(n // 2 + 1)[:, None] * (np.complex128(2j * np.pi) / span)


def derivative(x: Array, span: Array) -> Array:
    """dx/dt (n, K) of functions that repeat after the span."""
    spectrum = harmonics(x) * frequencies(len(x), span)
    spectrum[-1] = 0.0
    return samples(spectrum, len(x))


def integral(x: Array, span: Array, flipping: bool) -> Array:
    """The periodic integral (n, K) of x less its mean; its own mean is zero."""
    return span * _apply(_integral, x, flipping)


def refined(x: Array) -> Array:
    """Functions that repeat after the span at twice as many samples, (2n, K)."""
    return samples(harmonics(x), 2 * len(x)) * 2


def peak(x: Array, flipping: bool) -> Array:
    """Largest |x| (K,), between the samples too.

    The spectrum padded with zeros gives samples at least four times as dense, a parabola
    through the largest of them and its neighbours the rest.
    """
    size = np.abs(_apply(_resampled, x, flipping))
    top, column = size.argmax(axis=0), np.arange(size.shape[1])
    left, middle, right = (size[(top + k) % len(size), column] for k in (-1, 0, 1))
    bend = left - 2 * middle + right
    return middle - (right - left) ** 2 / (8 * np.where(bend < 0, bend, -np.inf))


def tail(x: Array, flipping: bool) -> Array:
    """Size of the fastest eighth of the harmonics, (K,), in the unit of x."""
    return np.abs(_apply(_tail, x, flipping)).max(axis=0)


def matrices(n: int, flipping: bool) -> tuple[Array, Array, Array]:
    """What stands behind `integral` over a span of 1, `tail` and `peak`, as matrices (.., n)."""
    integral, fastest, dense = (
        _matrix(operation, n, flipping) for operation in (_integral, _tail, _resampled)
    )
    return integral, fastest, dense


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
    spectrum = harmonics(whole)
    spectrum[0] = 0.0
    spectrum[1:] /= 2j * np.pi * np.arange(1, len(spectrum))[:, None] * len(x) / len(whole)
    return samples(spectrum, len(whole))[: len(x)]


def _resampled(x: Array, flipping: bool) -> Array:
    factor = max(4, _SMOOTH // len(x))
    whole = _repeating(x, flipping)
    dense = samples(harmonics(whole), factor * len(whole)) * factor
    return dense[: factor * len(x)]


def _tail(x: Array, flipping: bool) -> Array:
    whole = _repeating(x, flipping)
    spectrum = harmonics(whole) * (2 / len(whole))
    top = spectrum[-1 - len(spectrum) // 8 : -1]
    return np.concatenate([top.real, top.imag])
