"""The command with which a servo makes the joint follow a gait.

A servo that lags, and whose zero is off, makes of its command u the angle phi with

    beta phi" + tau phi' + phi = u + shift

as long as it keeps its rate limit. So every phi has a command, found without integration: of each
harmonic 1 + i w tau - w^2 beta times as much. Gaits are optimised as what the joint does, which
knows no servo, and reported as commands.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rr_opt.model.fields import Interval
from rr_opt.model.gait import FourierGait, FreeGait, Gait, SineGait

_HARMONICS, _SAMPLES = 64, 4096
"""Harmonics of the command for a gait whose acceleration jumps: those of phi fall as 1/n^3."""


@dataclass(frozen=True)
class LinearServo:
    """tau (s), beta (s2) and shift (rad) of the equation above; rate (rad/s): the largest that it
    makes, inf if there is no limit."""

    tau: float = 0.0
    beta: float = 0.0
    shift: float = 0.0
    rate: float = math.inf

    @property
    def lags(self) -> bool:
        """Whether the joint swings by another amount than the command."""
        return self.tau != 0 or self.beta != 0

    def gain(self, period: Any) -> Any:
        """Amplitude of the joint over that of a sine command of this period, s: a number, array or
        CasADi expression."""
        omega = 2 * math.pi / period
        return ((1 - omega**2 * self.beta) ** 2 + (omega * self.tau) ** 2) ** -0.5

    def command_for(self, gait: Gait) -> Gait:
        """The command of which the servo makes this gait; of a sine without its lead in time, which
        no steady motion depends on."""
        offset = gait.offset - self.shift
        if not self.lags:
            return gait.resized(gait.amplitude, gait.period, offset)
        if isinstance(gait, SineGait):
            return SineGait(gait.amplitude / self.gain(gait.period), gait.period, offset)
        parts = _harmonics(gait)
        return _fourier(gait.period, offset, parts / self._response(gait.period, len(parts)))

    def response_to(self, gait: Gait) -> Gait:
        """The joint's motion for a command within its rate limit: the inverse of `command_for`."""
        offset = gait.offset + self.shift
        if not self.lags:
            return gait.resized(gait.amplitude, gait.period, offset)
        parts = _harmonics(gait)
        return _fourier(gait.period, offset, parts * self._response(gait.period, len(parts)))

    def _response(self, period: float, harmonics: int) -> NDArray[np.complex128]:
        omega = 2 * math.pi * np.arange(1, harmonics + 1) / period
        return np.asarray(1 / (1 + 1j * omega * self.tau - omega**2 * self.beta), complex)


@dataclass(frozen=True)
class CommandBounds:
    """Bounds of the command's amplitude, rad, and the servo that follows it.

    A problem that has these is posed for the joint. Its own amplitude bounds enclose all that the
    servo makes of these; with a lag, that depends on the period. They are unchanged for a gait that
    is no sine: then the swing of the joint is bounded, not that of the command.
    """

    amplitude: Interval
    servo: LinearServo

    def joint_amplitude(self, period: Any) -> tuple[Any, Any]:
        """The least and the largest amplitude of a sine of the joint with this period, s."""
        gain = self.servo.gain(period)
        return self.amplitude.low * gain, self.amplitude.high * gain


def _harmonics(gait: Gait) -> NDArray[np.complex128]:
    """Complex amplitudes of exp(i n w t), n = 1, 2, ..., whose real parts make phi - offset."""
    if isinstance(gait, SineGait):
        return np.array([-1j * gait.amplitude])
    if isinstance(gait, FourierGait):
        return np.array(gait.cosines) - 1j * np.array(gait.sines)
    if not isinstance(gait, FreeGait):
        raise TypeError(f"no harmonics are known of a gait of shape {gait.shape!r}")
    phi = gait.angle(np.arange(_SAMPLES) / _SAMPLES * gait.period)
    return 2 * np.fft.rfft(phi)[1 : _HARMONICS + 1] / _SAMPLES


def _fourier(period: float, offset: float, parts: NDArray[np.complex128]) -> FourierGait:
    return FourierGait(
        period, offset, tuple((-parts.imag).tolist()), tuple(np.real(parts).tolist())
    )
