"""Calculus on samples of periodic functions by Fourier series, and linear equations with them.

Samples x (n, K): n equal steps (n even) along the first axis, over one `span` (K,), s, of K
functions. A function repeats after its span. Over half a period of a straight gait some functions
repeat and some change sign; the latter are `flipping` and repeat after two spans.

The repeating solution of dv/dt = a v + b takes an integrating factor, exp(-A), where dA/dt is a
less its mean and A is periodic. Two methods follow: one exact for every harmonic, one accurate
however much A varies.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.fft import irfft, rfft
from numpy.typing import NDArray

from rr_opt.array import Array

Spectrum = NDArray[np.complex128]
_Operation = Callable[[Array, bool], Array]

_DENSE = 64
"""Samples up to which one matrix product is faster than the equivalent transforms."""

_FINER = 4
"""Oversampling factor that resolves changes of sign."""

_SMOOTH = 256
"""Samples above which a peak is resolved well enough for a parabola."""


def harmonics(x: Array) -> Spectrum:
    """The spectrum (n/2 + 1, K) of x: n times its mean, then the coefficient of each frequency."""
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

    The zero-padded spectrum gives samples at least four times as dense, and a parabola through the
    largest of them and its neighbours gives the peak.
    """
    size = np.abs(_apply(_resampled, x, flipping))
    top, column = size.argmax(axis=0), np.arange(size.shape[1])
    left, middle, right = (size[(top + k) % len(size), column] for k in (-1, 0, 1))
    bend = left - 2 * middle + right
    return middle - (right - left) ** 2 / (8 * np.where(bend < 0, bend, -np.inf))


def peaks(x: Array, parts: int) -> Array:
    """Largest |x| in each part of the span, (parts, K): as `peak`, so that it moves smoothly."""
    size = np.abs(_resampled(x, False))
    n = len(size) // parts
    column = np.arange(size.shape[1])
    found = []
    for part in range(parts):
        top = part * n + size[part * n : (part + 1) * n].argmax(axis=0)
        left, middle, right = (size[(top + k) % len(size), column] for k in (-1, 0, 1))
        bend, slope = left - 2 * middle + right, (right - left) / 2
        shift = np.where(bend < 0, -slope / np.where(bend < 0, bend, -1.0), 0.0)
        shift = np.clip(shift, -0.5, 0.5)
        found.append(middle + shift * (slope + shift * bend / 2))
    return np.array(found)


def positive_mean(x: Array) -> Array:
    """Mean of the positive part (K,) of functions that repeat after the span.

    It is the gain of the integral from each upward zero crossing to the next downward one. The
    integral is stationary at a zero, so the zeros need little accuracy.
    """
    n = _FINER * len(x)
    fine = samples(harmonics(x), n) * _FINER if len(x) > 1 else np.repeat(x, n, axis=0)
    mean = x.mean(axis=0)
    whole = _integral(fine, False) + mean * np.arange(n)[:, None] / n
    after, gained = np.roll(fine, -1, axis=0), np.roll(whole, -1, axis=0)
    gained[-1] += mean
    at = np.nonzero((fine > 0) != (after > 0))
    start, end = fine[at], after[at]
    s = start / (start - end)
    # The Hermite cubic has the slopes of the integral, which are the function's values.
    here = whole[at] * (1 + 2 * s) * (1 - s) ** 2 + gained[at] * s**2 * (3 - 2 * s)
    here += s * (1 - s) * ((1 - s) * start - s * end) / n
    turns = np.bincount(at[1], np.where(start > 0, here, -here), minlength=x.shape[1])
    return np.asarray(turns + np.where(fine[0] > 0, mean, 0.0), float)


def tail(x: Array, flipping: bool) -> Array:
    """Magnitude of the highest eighth of the harmonics, (K,), in the unit of x."""
    return np.abs(_apply(_tail, x, flipping)).max(axis=0)


def matrices(n: int, flipping: bool) -> tuple[Array, Array, Array]:
    """`integral` over a span of 1, `tail` and `peak` as matrices (.., n)."""
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


_STIFF = 15.0
"""Range of A beyond which rounding, amplified by exp(A), exceeds the error of `solve_stiff`."""
_SHARE, _REPLACED = 0.8, 120
"""Largest contraction factor for which `_by_replacing` is used, and its most iterations."""
_REACH = 1.0
"""Largest a times a step that `solve_stiff` resolves; beyond it, the integrals are inaccurate."""

_NEAR = (-2, -1, 0, 1, 2, 3)
"""Samples, relative to the start of a step, that interpolate the integrand."""


_POWERS = np.arange(len(_NEAR))
_WEIGHTS = np.linalg.solve(np.array(_NEAR, float) ** _POWERS[:, None], 1 / (_POWERS + 1.0))
"""Quadrature weights of the samples _NEAR over a step of length 1: exact for polynomials."""


def solve(a: Array, b: Array, span: Array) -> tuple[Array, Array, Array]:
    """v (n, K), the mean of a (K,), and the relative rounding error of v, (K,), by harmonics.

    y = v exp(-A) obeys dy/dt = mean y + b exp(-A), whose coefficient is constant: every
    harmonic of y is that of b exp(-A) over (i omega - mean).
    """
    omega = frequencies(len(a), span)
    A, mean = _exponent(a, omega)
    growth = np.exp(A)
    forcing = harmonics(b / growth)
    forcing /= omega - mean
    v, magnified = growth * samples(forcing, len(a)), np.ptp(A, axis=0)
    rounding = np.finfo(float).eps * np.exp(magnified)
    least, most = a.min(axis=0), a.max(axis=0)
    stiff = magnified > _STIFF
    even = stiff & (most - least < -_SHARE * (most + least))
    resolved = stiff & ~even & (np.maximum(-least, most) * span / len(a) <= _REACH)
    for which, way in ((even, _by_replacing), (resolved, solve_stiff)):
        if which.any():
            v[:, which] = way(a[:, which], b[:, which], span[which])[0]
            rounding[which] = 0.0
    return v, mean, rounding


def _by_replacing(a: Array, b: Array, span: Array) -> tuple[Array, Array]:
    """v (n, K) by fixed-point iteration, and the constant (K,) that replaces a; the remainder times
    v is added to b. Where a has one sign, the error contracts by (most - least)/(most + least)."""
    middle = (a.max(axis=0) + a.min(axis=0)) / 2
    divisor, rest, v = frequencies(len(a), span) - middle, a - middle, np.zeros_like(b)
    for _ in range(_REPLACED):
        before, v = v, samples(harmonics(b + rest * v) / divisor, len(a))
        if not (np.abs(v - before).max(axis=0) > 1e-13 * np.abs(v).max(axis=0)).any():
            break
    return v, middle


def solve_stiff(a: Array, b: Array, span: Array) -> tuple[Array, Array]:
    """v (n, K), and the mean of a (K,), for an a that dry friction makes large and abrupt.

    exp(A) may then span more orders of magnitude than a float can represent, but over one step it
    does not. So each step from sample to sample becomes a map v -> gain v + shift, with the
    integral in it of order six; the maps over 1, 2, 4 .. n steps from every sample follow by
    composing pairs, and the last of them close the cycle. n is a power of two.
    """
    n, h = len(a), span / len(a)
    A, mean = _exponent(a, frequencies(n, span))
    # Clipped: where a step is stiffer, the sampling density limits the accuracy of v.
    gain = np.exp(np.clip(_ahead(A, 1) - A + mean * h, -10.0, 1.0))
    # exp of the integral of a from each nearby sample to the end of the step, one gain at a time.
    next1, next2, last1, last2 = (_ahead(gain, k) for k in (1, 2, -1, -2))
    factors = (gain * last1 * last2, gain * last1, gain, 1.0, 1 / next1, 1 / (next1 * next2))
    shift = np.zeros_like(a)
    for k, weight, factor in zip(_NEAR, _WEIGHTS, factors, strict=True):
        shift += weight * factor * _ahead(b, k)
    shift *= h
    steps = 1
    while steps < n:
        later = _ahead(gain, steps)
        shift = later * shift + _ahead(shift, steps)
        gain = later * gain
        steps *= 2
    return shift / (1 - gain), mean


def _ahead(x: Array, k: int) -> Array:
    """The cyclic samples x (n, K), k steps ahead; np.roll takes as long as the arithmetic."""
    return np.concatenate([x[k:], x[:k]])


def _exponent(a: Array, omega: Spectrum) -> tuple[Array, Array]:
    """A (n, K) and the mean of a (K,)."""
    spectrum = harmonics(a)
    mean = spectrum[0].real / len(a)
    spectrum[0] = 0.0
    spectrum[1:] /= omega[1:]
    return samples(spectrum, len(a)), mean
