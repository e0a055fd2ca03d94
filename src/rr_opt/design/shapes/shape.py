"""The interface between a shape of gait and multiple shooting.

phi is a function of the phase theta alone, given the shape's decisions and, for a shape that is
not one formula, unknowns at every node. Rates are in radians per period until the period divides
them, so that it does not get into the shape.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import reach_before_singularity
from rr_opt.model.gait import Gait
from rr_opt.model.problem import Interval, Problem

Symbols = Mapping[str, Any]
Values = Mapping[str, Any]

ZERO = Interval(0.0, 0.0)


@dataclass(frozen=True)
class Bounds:
    """Bounds by name; what has no name is free.

    unknowns  of decisions, integrals, states and controls
    rows      of limits and path rows
    """

    unknowns: Mapping[str, Interval] = field(default_factory=dict)
    rows: Mapping[str, Interval] = field(default_factory=dict)


class Shape(Protocol):
    """A shape; hashable, as programs are kept by shape.

    decisions   unknowns that hold for the whole period, beside period, ballast and turn
    states      unknowns at every node that an interval carries on to the next
    controls    unknowns at every node, constant over the interval that begins there
    integrals   means over the period that rows and bounds need
    limits      rows that hold once a period
    path        rows at every node
    checks      how many numbers it is given, such as phases, that `limits` depend on
    """

    @property
    def decisions(self) -> tuple[str, ...]:
        """See above."""
        ...

    @property
    def states(self) -> tuple[str, ...]:
        """See above."""
        ...

    @property
    def controls(self) -> tuple[str, ...]:
        """See above."""
        ...

    @property
    def integrals(self) -> tuple[str, ...]:
        """See above."""
        ...

    @property
    def limits(self) -> tuple[str, ...]:
        """See above."""
        ...

    @property
    def path(self) -> tuple[str, ...]:
        """See above."""
        ...

    @property
    def checks(self) -> int:
        """See above."""
        ...

    def angle(self, z: Symbols, local: Symbols, theta: Any, since: Any) -> tuple[Any, Any, Any]:
        """phi, dphi/dtheta, d2phi/dtheta2 (rad) at phase theta, `since` after the node."""
        ...

    def integrands(self, phi: Any, theta: Any) -> tuple[Any, ...]:
        """What `integrals` are the means of."""
        ...

    def limit_rows(
        self, z: Symbols, means: Symbols, checks: tuple[Any, ...], c1: Any, c2: Any
    ) -> tuple[Any, ...]:
        """The rows of `limits`."""
        ...

    def path_rows(
        self, z: Symbols, local: Symbols, theta: Any, width: Any, at: Any
    ) -> tuple[Any, ...]:
        """The rows of `path` of the interval from theta on, and `at` a fraction of its width."""
        ...

    def given(self, problem: Problem, added: Array) -> Array:
        """The numbers (checks,) of a problem; added: phases at which limits were broken."""
        ...

    def bounds(self, problem: Problem) -> Bounds:
        """What the problem says of the shape's unknowns and rows."""
        ...

    def start(self, gait: Gait, phases: Array) -> dict[str, Any]:
        """Decisions, integrals, states and controls of a gait, or of one close to it."""
        ...

    def gait(self, values: Values) -> Gait:
        """The gait of a solution."""
        ...

    def prices(self, problem: Problem, multipliers: Values) -> dict[str, float]:
        """Speed gained per unit of the limits on rate, angle and singularity."""
        ...

    def bound_prices(self, on_bounds: Values, multipliers: Values) -> dict[str, float]:
        """Speed gained per unit by which an active bound of amplitude or offset moves up."""
        ...


PATH = ("angle", "swing", "rate")
"""phi, phi - phi0 and dphi/dt."""


def path_bounds(problem: Problem) -> dict[str, Interval]:
    """Bounds of PATH. The singular posture is one of two angles, so its margin is one as well."""
    limits = problem.limits
    reach = min(limits.angle, reach_before_singularity(problem.robot, limits.singularity))
    swing, rate = problem.gait.amplitude.high, limits.rate
    return {
        "angle": Interval(-reach, reach),
        "swing": Interval(-swing, swing),
        "rate": Interval(-rate, rate),
    }


def path_prices(problem: Problem, multipliers: Values) -> dict[str, float]:
    """Speed gained per unit of the limits on rate, angle and singularity."""
    limits, robot = problem.limits, problem.robot
    rate, angle = (float(np.abs(multipliers[name]).sum()) for name in ("rate", "angle"))
    edge = reach_before_singularity(robot, limits.singularity)
    if limits.angle <= edge:
        return {"rate": rate, "angle": angle, "singularity": 0.0}
    # c1 cos(edge) + c2 = margin, so a wider margin brings the edge closer.
    closer = 1 / (robot.platform1.c * math.sin(edge))
    return {"rate": rate, "angle": 0.0, "singularity": -angle * closer}


def amplitude_price(first_harmonic: float, swing: Values) -> float:
    """Speed gained per unit by which the active bound of the amplitude moves up: the largest
    amplitude holds the swing, the least one the first harmonic."""
    most = float(np.abs(swing["swing"]).sum())
    return most if most > abs(first_harmonic) else float(first_harmonic)
