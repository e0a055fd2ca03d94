"""A gait of several harmonics."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_SAMPLES = 64
"""Samples per harmonic among which an extreme is looked for."""


@dataclass(frozen=True)
class FourierGait:
    """phi(t) = offset + sum over n of sines[n-1] sin(2 pi n t/T) + cosines[n-1] cos(2 pi n t/T).

    period (T) in s, offset (phi0), sines (alpha_n) and cosines (beta_n), as many of each, in rad.
    """

    period: float
    offset: float
    sines: tuple[float, ...]
    cosines: tuple[float, ...]

    shape = "fourier"
    pieces = 1

    @property
    def harmonics(self) -> int:
        """How many."""
        return len(self.sines)

    @property
    def amplitude(self) -> float:
        """Largest |phi - phi0| over a period, rad."""
        return self._peak(0, 0.0)

    @property
    def peak_angle(self) -> float:
        """Largest |phi| over a period, rad."""
        return self._peak(0, self.offset)

    @property
    def peak_rate(self) -> float:
        """Largest |dphi/dt| over a period, rad/s."""
        return self._peak(1, 0.0)

    def resized(self, amplitude: float, period: float, offset: float) -> FourierGait:
        """The same shape with another amplitude (rad), period (s) and offset (rad)."""
        factor = amplitude / self.amplitude
        sines, cosines = (
            tuple(factor * size for size in sizes) for sizes in (self.sines, self.cosines)
        )
        return FourierGait(period, offset, sines, cosines)

    def angle(self, t: ArrayLike) -> Array:
        """phi, rad, in the shape of t (s)."""
        return self.offset + self._derivative(0, t)

    def rate(self, t: ArrayLike) -> Array:
        """dphi/dt, rad/s, in the shape of t (s)."""
        return self._derivative(1, t)

    def acceleration(self, t: ArrayLike) -> Array:
        """d2phi/dt2, rad/s2, in the shape of t (s)."""
        return self._derivative(2, t)

    def _derivative(self, order: int, t: ArrayLike) -> Array:
        """The order-th derivative of phi - phi0: each one turns a harmonic by a quarter."""
        t = np.asarray(t, float)
        total = np.zeros_like(t)
        for n, (sine, cosine) in enumerate(zip(self.sines, self.cosines, strict=True), 1):
            omega = 2 * math.pi * n / self.period
            turned = omega * t + order * math.pi / 2
            total = total + omega**order * (sine * np.sin(turned) + cosine * np.cos(turned))
        return total

    def _peak(self, order: int, shift: float) -> float:
        """Largest |shift + derivative|: sampled, then by Newton's method on its own slope."""
        t = np.arange(_SAMPLES * self.harmonics) * self.period / (_SAMPLES * self.harmonics)
        size = np.abs(shift + self._derivative(order, t))
        at = t[size >= np.maximum(np.roll(size, 1), np.roll(size, -1))]
        for _ in range(4):
            slope, bend = (self._derivative(order + k, at) for k in (1, 2))
            step = np.where(np.abs(bend) > 0, slope / np.where(bend == 0, 1.0, bend), 0.0)
            at = at - np.clip(step, -t[1], t[1])
        peaks = np.abs(shift + self._derivative(order, at))
        return float(max(size.max(), peaks.max(initial=0.0)))
