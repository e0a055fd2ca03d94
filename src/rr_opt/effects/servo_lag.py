"""A servo that follows its command late and with a smaller swing: beta phi" + tau phi' + phi =
command.

Without beta it is a first-order lag. The command is a Fourier series, to which the lag responds
term by term with 1/(1 + i w tau - w^2 beta). From rest the response is that to the periodic command
plus free terms that make up for the difference in angle and rate at t = 0, and decay.
"""

import cmath
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rr_opt.array import Array
from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.drive import Drive, FreeJoint
from rr_opt.model.servo_command import LinearServo

_SAMPLES = 512
_FIRST_ORDER = 1e-6
"""A smaller beta, in units of tau squared, decays within any step."""
_NEGLIGIBLE = 1e-10
"""A smaller term, relative to the largest, is left out."""
_DECAYED = 40.0
"""Time constants after which nothing is left of a free term."""


def _actuate(command: Drive, values: Mapping[str, float], _: FreeJoint | None = None) -> Drive:
    tau, beta = values["tau"], values.get("beta", 0.0)
    if tau <= 0:
        return command
    grid = command.period * np.arange(_SAMPLES) / _SAMPLES
    terms = np.fft.rfft(command.at(grid)[0]) / _SAMPLES
    terms[1:] *= 2
    mean, terms[0] = float(terms[0].real), 0.0
    kept = np.flatnonzero(np.abs(terms) > _NEGLIGIBLE * np.abs(terms).max())
    omega = 2 * np.pi * kept / command.period
    response = terms[kept] / (1 + 1j * omega * tau - omega**2 * beta)
    derivatives = np.array([np.ones_like(omega), 1j * omega, -(omega**2)]) * response

    def steady(t: Array) -> Array:
        phase = omega[:, None] * np.asarray(t)[None]
        path = derivatives.real @ np.cos(phase) - derivatives.imag @ np.sin(phase)
        path[0] += mean
        return path

    if not command.rest:
        return replace(command, at=steady)
    before = command.at(np.array([-1.0]))[0, 0]
    angle, rate, _ = steady(np.array([0.0]))[:, 0]
    rates, amounts = _free_response(tau, beta, before - angle, -rate)

    free = amounts * rates ** np.arange(3)[:, None]
    over = _DECAYED / np.abs(rates.real).min()

    def from_rest(t: Array) -> Array:
        t = np.asarray(t, float)
        path = steady(t)
        since = (t >= 0) & (t < over)
        path[:, since] += (free @ np.exp(rates[:, None] * t[since])).real
        path[:, t < 0] = [[before], [0.0], [0.0]]
        return path

    return replace(command, at=from_rest)


def _free_response(tau: float, beta: float, angle: float, rate: float) -> tuple[Array, Array]:
    """Rates (1/s) and amounts (rad) of the exponentials that start from this angle and rate."""
    if beta < _FIRST_ORDER * tau**2:
        return np.array([-1 / tau]), np.array([angle])
    # A double root is split by a hair, which changes nothing that counts.
    apart = cmath.sqrt(tau**2 - 4 * beta) or 1e-6 * tau
    rates = np.array([-tau + apart, -tau - apart]) / (2 * beta)
    first = (rate - rates[1] * angle) / (rates[0] - rates[1])
    return rates, np.array([first, angle - first])


EFFECT = Effect(
    name="servo_lag",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(
        Parameter("tau", "s", (0.0, 0.5), 0.02),
        Parameter("beta", "s^2", (0.0, 0.05), 2e-4),
    ),
    sentence="The servo follows its command with a delay and a smaller amplitude.",
    actuate=_actuate,
    linear=lambda values: LinearServo(values["tau"], values.get("beta", 0.0)),
    forms=(("tau",), ("tau", "beta")),
)
