"""The gait: the angle phi(t) between the platforms that the servo is told to follow."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class Gait(Protocol):
    """A periodic phi(t), whatever its shape."""

    @property
    def shape(self) -> str:
        """`sine`, `fourier` or `free`."""
        ...

    @property
    def period(self) -> float:
        """T, s."""
        ...

    @property
    def offset(self) -> float:
        """phi0, the mean of phi over a period, rad."""
        ...

    @property
    def amplitude(self) -> float:
        """Largest |phi - phi0|, rad."""
        ...

    @property
    def pieces(self) -> int:
        """Into how many equal parts of the period the jumps of the acceleration cut it; 1 where
        phi is smooth."""
        ...

    @property
    def peak_angle(self) -> float:
        """Largest |phi| over a period, rad."""
        ...

    @property
    def peak_rate(self) -> float:
        """Largest |dphi/dt| over a period, rad/s."""
        ...

    def resized(self, amplitude: float, period: float, offset: float) -> Self:
        """The same shape with another amplitude (rad), period (s) and offset (rad).

        Raises ZeroDivisionError for a shape that does not move, unless it is a sine.
        """
        ...

    def angle(self, t: ArrayLike) -> Array:
        """phi, rad, in the shape of t (s)."""
        ...

    def rate(self, t: ArrayLike) -> Array:
        """dphi/dt, rad/s, in the shape of t (s)."""
        ...

    def acceleration(self, t: ArrayLike) -> Array:
        """d2phi/dt2, rad/s2, in the shape of t (s); at a jump, the value after it."""
        ...


@dataclass(frozen=True)
class SineGait:
    """phi(t) = amplitude sin(2 pi t/period) + offset (the paper's equation 5).

    amplitude (alpha) and offset (phi0) in rad, period (T) in s.
    """

    amplitude: float
    period: float
    offset: float = 0.0

    shape = "sine"
    pieces = 1

    @property
    def angular_frequency(self) -> float:
        """2 pi/T, rad/s."""
        return 2 * math.pi / self.period

    @property
    def peak_angle(self) -> float:
        """Largest |phi| over a period, rad."""
        return abs(self.offset) + abs(self.amplitude)

    @property
    def peak_rate(self) -> float:
        """Largest |dphi/dt| over a period, rad/s."""
        return abs(self.amplitude) * self.angular_frequency

    def resized(self, amplitude: float, period: float, offset: float) -> SineGait:
        """The sine with these values."""
        return SineGait(amplitude, period, offset)

    def angle(self, t: ArrayLike) -> Array:
        """phi, rad, in the shape of t (s)."""
        return self.amplitude * np.sin(self.angular_frequency * np.asarray(t, float)) + self.offset

    def rate(self, t: ArrayLike) -> Array:
        """dphi/dt, rad/s, in the shape of t (s)."""
        turn = self.angular_frequency * np.asarray(t, float)
        return self.amplitude * self.angular_frequency * np.cos(turn)

    def acceleration(self, t: ArrayLike) -> Array:
        """d2phi/dt2, rad/s2, in the shape of t (s)."""
        turn = self.angular_frequency * np.asarray(t, float)
        return -self.amplitude * self.angular_frequency**2 * np.sin(turn)
