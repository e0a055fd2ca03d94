"""What a push that the model lacks may depend on, each as a spline or a few harmonics.

A term is a kind of push (a rolling force that resists, one that pushes, a side speed of an axle, an
error of the angle), a variable, and a basis over it. The basis is piecewise linear between knots at
which the recordings say equally much; over an angle it is a constant and two harmonics.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.effects.coulomb_friction import SMOOTHING_SPEED
from rr_opt.machines.racer.observed import Along
from rr_opt.machines.racer.unknown_input import PUSHES

KNOTS = 8
_HARMONICS = 2
_SLOWEST = 0.1
"""Quantile of the slowest speed at which friction is told: below, noise decides which way it is."""


@dataclass(frozen=True)
class Variable:
    """A quantity along a run: its name, unit, and whether it goes round.

    of  Along -> (4, n) at the wheels, (2, n) at the axles, or (n,) of the robot
    """

    name: str
    unit: str
    of: Callable[[Along], Array]
    round: bool = False


SPEED = Variable("speed", "m/s", lambda along: np.abs(along.u))
SIGNED = Variable("rolling speed", "m/s", lambda along: along.axles)
ANGLE = Variable("servo angle", "rad", lambda along: along.phi)
RATE = Variable("servo rate", "rad/s", lambda along: along.dphi)
ACCELERATION = Variable("servo acceleration", "rad/s^2", lambda along: along.ddphi)
TURNING = Variable("sideways acceleration", "m/s^2", lambda along: along.axles * along.w)
TIME = Variable("time", "s", lambda along: along.t - along.t[0])
PLACE_X = Variable("place x", "m", lambda along: along.x)
PLACE_Y = Variable("place y", "m", lambda along: along.y)
HEADING = Variable("heading", "rad", lambda along: along.psi, round=True)


def wheel_turn(radius: float) -> Variable:
    """The angle by which the wheels of a radius (m) turned since the recording began."""
    return Variable("wheel angle", "rad", lambda along: along.rolled / radius, round=True)


@dataclass(frozen=True)
class Kind:
    """What is pushed, and how a value of the curve becomes a push.

    size  (typical force N, speed m/s) -> the usual size of the curve's values
    push  (values of the curve, Along) -> rows of PUSHES (7, n)
    """

    name: str
    unit: str
    says: str
    size: Callable[[float, float], float]
    push: Callable[[Array, Along], Array]


def _rows(n: int, first: int, rows: Array) -> Array:
    out = np.zeros((len(PUSHES), n))
    out[first : first + len(rows)] = rows
    return out


def _force(name: str, unit: str, says: str, against: Callable[[Array], Array]) -> Kind:
    """A rolling force at every wheel, against what its speed u makes of it."""
    return Kind(
        name,
        unit,
        says,
        lambda force, speed: force if unit == "N" else force / speed,
        lambda f, along: _rows(along.t.size, 0, -f * against(along.u)),
    )


def _side(axle: int) -> Kind:
    def push(f: Array, along: Along) -> Array:
        return _rows(along.t.size, 3 + axle, np.broadcast_to(f, (2, along.t.size))[axle - 1 : axle])

    return Kind(
        f"side speed of axle {axle}",
        "m/s",
        "drifts to the left",
        lambda _, speed: 0.01 * speed,
        push,
    )


DRY = _force("rolling force", "N", "resists motion", lambda u: np.tanh(u / SMOOTHING_SPEED))
DRAG = _force("drag", "N s/m", "resists motion in proportion to speed", lambda u: u)
PUSH = _force("rolling force", "N", "pushes forward", lambda u: -np.ones_like(u))
SIDE1, SIDE2 = _side(1), _side(2)
ERROR = Kind(
    "error of the servo angle",
    "rad",
    "is more than was told",
    lambda *_: 0.003,
    lambda f, along: _rows(along.t.size, 6, f[None]),
)


@dataclass(frozen=True)
class Term:
    """A kind of push as a function of a variable; knots (k,) of its basis if it is no angle."""

    kind: Kind
    variable: Variable
    knots: Array

    @property
    def columns(self) -> int:
        """How many numbers the function has."""
        return len(self._shapes)

    @property
    def weights(self) -> Array:
        """By how much the function is known not to be rough, as a quadratic form of its numbers."""
        if self.variable.round:
            return np.eye(self.columns)
        changes = np.diff(self._shapes, axis=1)
        return changes @ changes.T

    @property
    def _varies(self) -> bool:
        """Whether the constant part is left to the curve of friction over speed."""
        return self.kind in (DRY, DRAG) and self.variable is not SPEED

    @property
    def _shapes(self) -> Array:
        """The functions of the basis (columns, ...) as values at the knots, or as waves."""
        whole = np.eye(1 + 2 * _HARMONICS if self.variable.round else self.knots.size)
        if not self._varies:
            return whole
        if self.variable.round:
            return whole[1:]
        # What is orthogonal to a constant: all columns but the first of ones' QR decomposition.
        return np.linalg.qr(np.column_stack([np.ones(len(whole)), whole[:, 1:]]))[0][:, 1:].T

    def basis(self, at: Array) -> Array:
        """The functions (columns, ...) of the basis at values of the variable (...)."""
        if self.variable.round:
            waves = [wave(k * at) for k in range(1, _HARMONICS + 1) for wave in (np.cos, np.sin)]
            return np.tensordot(self._shapes, np.array([np.ones_like(at), *waves]), 1)
        return np.array([np.interp(at, self.knots, shape) for shape in self._shapes])

    def pushes(self, along: Along) -> Array:
        """How each number of the function pushes (columns, 7, n)."""
        return np.array([self.kind.push(f, along) for f in self.basis(self.variable.of(along))])

    def shown_at(self) -> Array:
        """Values of the variable at which to show the function."""
        return np.linspace(-np.pi, np.pi, 13) if self.variable.round else self.knots


def terms(seen: Sequence[Along], radius: float, *, slips: bool) -> list[Term]:
    """All terms, their knots at quantiles of what was seen in the runs."""
    turn = wheel_turn(radius)
    wanted = [(DRY, SPEED)]
    for variable in (ANGLE, RATE, TIME, PLACE_X, PLACE_Y, HEADING, turn):
        wanted += [(kind, variable) for kind in (DRY, DRAG, PUSH)]
    if not slips:
        wanted += [(side, var) for side in (SIDE1, SIDE2) for var in (SIGNED, TURNING, ANGLE, RATE)]
    wanted += [(ERROR, variable) for variable in (ANGLE, RATE, ACCELERATION, TIME)]
    return [
        Term(kind, variable, np.zeros(0) if variable.round else _knots(variable, seen))
        for kind, variable in wanted
    ]


def _knots(variable: Variable, seen: Sequence[Along]) -> Array:
    values = np.concatenate([variable.of(along).ravel() for along in seen])
    knots = np.quantile(values, np.linspace(_SLOWEST if variable is SPEED else 0.02, 0.98, KNOTS))
    return np.unique(np.round(knots, 12))


_OPPOSITES = {
    "resists motion": "helps motion",
    "resists motion in proportion to speed": "helps motion in proportion to speed",
    "pushes forward": "pushes backward",
    "drifts to the left": "drifts to the right",
    "is more than was told": "is less than was told",
}
_MOST = 0.8
"""Of all ups and downs has to go one way, or happen on one side of a value, for it to be named."""


def shape(says: str, variable: str, unit: str, at: Array, mean: Array, error: Array) -> str:
    """What a curve (mean (k,) with standard errors, over `at` (k,)) does, in words.

    says  what a positive value does; where the curve is negative throughout, its opposite is said
    """
    weight = 1 / np.maximum(error, 1e-300) ** 2
    level = float(np.sum(weight * mean) / np.sum(weight))
    sure = np.abs(mean) > 2 * error
    signs = set(np.sign(mean[sure]))
    does = says
    if signs == {-1.0}:
        does, mean, level = _OPPOSITES[says], -mean, -level
    elif signs == {-1.0, 1.0}:
        does = f"{says} at some values of the {variable} and {_OPPOSITES[says]} at others"
    return f"{does}{_trend(variable, unit, at, mean, error, level)}"


def _trend(variable: str, unit: str, at: Array, mean: Array, error: Array, level: float) -> str:
    change = float(np.ptp(mean))
    if change < 0.15 * abs(level) or np.all(np.abs(mean - level) < 2 * error):
        return f", the same at every {variable}"
    steps = np.diff(mean)
    total = float(np.abs(steps).sum())
    for word, along in (("rises", steps), ("falls", -steps)):
        if float(np.maximum(along, 0).sum()) > _MOST * total:
            return f", and {word} with {variable}{_where(unit, at, along, total)}"
    most, least = at[np.argmax(mean)], at[np.argmin(mean)]
    return f", most at a {variable} of {most:.2g} {unit} and least at {least:.2g} {unit}"


def _where(unit: str, at: Array, along: Array, total: float) -> str:
    """Below or above what most of a change happens, if it is not all over the range."""
    done = np.cumsum(np.maximum(along, 0)) / total
    middle = (at[0] + at[-1]) / 2
    below = at[1:][np.argmax(done >= _MOST)]
    if below <= middle:
        return f" below {below:.2g} {unit}"
    above = at[:-1][done - np.maximum(along, 0) / total <= 1 - _MOST][-1]
    return f" above {above:.2g} {unit}" if above >= middle else ""
