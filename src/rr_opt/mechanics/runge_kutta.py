"""Explicit Runge-Kutta methods as data, and one stepper for all of them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

State = TypeVar("State")


@dataclass(frozen=True)
class Tableau:
    """A Butcher tableau: nodes c, rows a (strictly lower triangular), weights b, its order."""

    name: str
    order: int
    c: tuple[float, ...]
    a: tuple[tuple[float, ...], ...]
    b: tuple[float, ...]

    def step(self, rhs: Callable[[float, State], State], y: State, h: Any) -> State:
        """One step of length h from y; rhs(fraction, y) with fraction of the step in [0, 1].

        States are anything that adds and scales: floats, arrays, CasADi expressions.
        """
        slopes: list[State] = []
        for fraction, row in zip(self.c, self.a, strict=True):
            slopes.append(rhs(fraction, _combine(y, h, row, slopes)))
        return _combine(y, h, self.b, slopes)


def _combine(y, h, weights, slopes):
    for weight, slope in zip(weights, slopes, strict=True):
        if weight:
            y = y + (h * weight) * slope
    return y


RK4 = Tableau(
    name="rk4",
    order=4,
    c=(0, 1 / 2, 1 / 2, 1),
    a=((), (1 / 2,), (0, 1 / 2), (0, 0, 1)),
    b=(1 / 6, 1 / 3, 1 / 3, 1 / 6),
)
"""The classical method of Kutta (1901)."""

BUTCHER6 = Tableau(
    name="butcher6",
    order=6,
    c=(0, 1 / 3, 2 / 3, 1 / 3, 1 / 2, 1 / 2, 1),
    a=(
        (),
        (1 / 3,),
        (0, 2 / 3),
        (1 / 12, 1 / 3, -1 / 12),
        (-1 / 16, 9 / 8, -3 / 16, -3 / 8),
        (0, 9 / 8, -3 / 8, -3 / 4, 1 / 2),
        (9 / 44, -9 / 11, 63 / 44, 18 / 11, 0, -16 / 11),
    ),
    b=(11 / 120, 0, 27 / 40, 27 / 40, -4 / 15, -4 / 15, 11 / 120),
)
"""Seven stages, the least that reach order 6: Butcher, Numerical Methods for Ordinary Differential
Equations (2016), section 33."""
