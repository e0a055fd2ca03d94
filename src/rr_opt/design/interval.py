"""What one interval of multiple shooting contributes: values and derivatives.

They are compiled where a C compiler is at hand and it pays. CasADi's virtual machine takes some 4
ns an operation, and an interval with its derivatives has some 30 000. Compiled they take a fifth of
that, even unoptimised, as here: a compiler that optimises takes ten seconds over them instead of
one, for code that is less than twice as fast.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import casadi as ca

from rr_opt.design.shapes import Shape
from rr_opt.design.transcription import COMMON, DYNAMIC, GRIPS, MEANS, PeriodTerms, named
from rr_opt.mechanics.compile_cache import externals
from rr_opt.mechanics.runge_kutta import Tableau
from rr_opt.model.ballast import By, hang
from rr_opt.motion.dynamics import Dynamics, derive

_FLAGS = ("-O0", "-fPIC", "-shared")
_FEW, _PAYS = 500, 13_000
"""Evaluations of intervals after which it is seen whether the functions were compiled before, and
after which to compile them takes no longer than has been taken without."""


class Functions(NamedTuple):
    """Of an interval: its values, their Jacobian and their weighted Hessian."""

    step: ca.Function
    jacobian: ca.Function
    hessian: ca.Function


class Code:
    """Functions that are compiled once they are used often."""

    def __init__(self, functions: Functions) -> None:
        self.functions, self._asked = functions, 0
        self._compiled: Functions | None = None

    @property
    def compiled(self) -> Functions | None:
        """The compiled functions; None where there are none, or not yet."""
        return self._compiled

    def used(self, evaluations: int) -> None:
        """Add to the count of evaluations of the functions."""
        before, self._asked = self._asked, self._asked + evaluations
        if self._compiled is None and any(before < some <= self._asked for some in (_FEW, _PAYS)):
            make = self._asked >= _PAYS
            compiled = externals("interval", self.functions, _FLAGS, make=make)
            self._compiled = Functions(*compiled) if compiled else None


@lru_cache
def interval_of(
    effects: tuple[str, ...],
    by: By,
    shape: Shape,
    looks: int,
    substeps: int,
    method: Tableau,
    loads: tuple[str, ...],
) -> IntervalTerms:
    """The terms for these effects, this way of changing the inertia, shape and method."""
    return IntervalTerms(effects, by, shape, looks, substeps, method, loads)


class IntervalTerms:
    """What one interval contributes: values, first and second derivatives.

    code       step (local, theta, width, looks, z, fixed) -> states at the end, integrals, path
               rows; its Jacobian and, weighted, Hessian in (local, z)
    slopes, curves   their sparsity; they are given dense
    period     the rows of a whole period
    shared     length of `fixed`: robot, loads and ballast range
    """

    def __init__(
        self,
        effects: tuple[str, ...],
        by: By,
        shape: Shape,
        looks: int,
        substeps: int,
        method: Tableau,
        loads: tuple[str, ...],
    ):
        parameters = derive(effects).parameters
        z = ca.SX.sym("z", len(COMMON + shape.decisions))
        local_names = DYNAMIC + shape.states + shape.controls
        local, places = ca.SX.sym("local", len(local_names)), ca.SX.sym("looks", looks + 1)
        fixed = ca.SX.sym("fixed", len(parameters) + 5)
        theta, width = ca.SX.sym("theta"), ca.SX.sym("width")
        decided = named(COMMON + shape.decisions, z)
        values = _with_ballast(fixed, parameters, decided["ballast"], by)
        interval = _Interval(
            derive(effects), shape, values, decided, named(local_names, local), theta, width
        )
        end = interval.end(substeps, method)
        out = ca.cse(
            ca.vertcat(
                end[:2],
                *shape.angle(decided, interval.here, theta + width, width)[: len(shape.states)],
                end[2:],
                *shape.path_rows(decided, interval.here, theta, width, places[looks]),
                *interval.along(loads, end, ca.vertsplit(places)[:looks]),
            )
        )
        inner = ca.vertcat(local, z)
        inputs = [local, theta, width, places, z, fixed]
        weights = ca.SX.sym("weights", out.numel())
        slopes = ca.jacobian(out, inner)
        curves = ca.hessian(ca.dot(weights, out), inner)[0]
        self.shared = fixed.numel()
        self.slopes, self.curves = slopes.sparsity(), curves.sparsity()
        self.code = Code(
            Functions(
                ca.Function("step", inputs, [out]),
                ca.Function("jacobian", inputs, [ca.cse(ca.densify(slopes))]),
                ca.Function("hessian", [*inputs, weights], [ca.cse(ca.densify(curves))]),
            )
        )
        c1, c2 = (fixed[parameters.index(name)] for name in ("c1", "c2"))
        self.period = PeriodTerms(shape, z, fixed, c1, c2)


@dataclass(frozen=True)
class _Interval:
    """The motion within one interval, as expressions."""

    dynamics: Dynamics
    shape: Shape
    values: ca.SX
    decided: dict[str, ca.SX]
    here: dict[str, ca.SX]
    theta: ca.SX
    width: ca.SX

    def angle(self, fraction: float | ca.SX) -> tuple[Any, tuple[Any, Any, Any]]:
        """The phase, and phi, dphi, ddphi, at a fraction of the interval."""
        T, since = self.decided["period"], fraction * self.width
        at = self.theta + since
        phi, slope, bend = self.shape.angle(self.decided, self.here, at, since)
        return at, (phi, slope / T, bend / T**2)

    def motion(self, fraction: float, v: ca.SX) -> Any:
        """vdot, w, side, torque and what is integrated, at a fraction of the interval."""
        at, angle = self.angle(fraction)
        moved = self.dynamics.motion(v, *angle, self.values)
        return *moved, self.shape.integrands(angle[0], at)

    def rhs(self, fraction: float, y: ca.SX) -> ca.SX:
        """Derivative in theta of v, chi, V, E and the shape's integrals."""
        T = self.decided["period"]
        vdot, w, side, _, integrands = self.motion(fraction, y[0])
        cos, sin = ca.cos(y[1]), ca.sin(y[1])
        V = cos * y[0] - sin * side, sin * y[0] + cos * side
        return ca.vertcat(T * vdot, T * w - self.decided["turn"], *V, cos, sin, *integrands)

    def end(self, substeps: int, method: Tableau) -> ca.SX:
        """v, chi and the integrals at the end."""
        sums = len(MEANS) + len(self.shape.integrals)
        y = ca.vertcat(self.here["v"], self.here["chi"], ca.SX.zeros(sums))
        for part in range(substeps):
            y = method.step(
                lambda fraction, y, part=part: self.rhs((part + fraction) / substeps, y),
                y,
                self.width / substeps,
            )
        return y

    def along(self, loads: tuple[str, ...], end: ca.SX, places: list[ca.SX]) -> list[ca.SX]:
        """Each load at the node, at places within the interval and, where it jumps at nodes, at the
        end."""
        start = ca.vertcat(self.here["v"], self.here["chi"])
        v0, v1 = start[0], end[0]
        d0, d1 = (self.width * self.rhs(at, y)[0] for at, y in ((0.0, start), (1.0, end)))
        seen = [(0.0, v0), *((at, _cubic(at, v0, v1, d0, d1)) for at in places)]
        seen += [(1.0, v1)] if self.shape.controls else []
        known = [self._loads(at, v) for at, v in seen]
        return [each[load] for load in loads for each in known]

    def _loads(self, fraction: float | ca.SX, v: ca.SX) -> dict[str, ca.SX]:
        inputs = (v, *self.angle(fraction)[1], self.values)
        grips = zip(GRIPS, self.dynamics.grip(*inputs), strict=True)
        return {"torque": self.dynamics.motion(*inputs)[3], **dict(grips)}


def _cubic(at: ca.SX, v0: ca.SX, v1: ca.SX, d0: ca.SX, d1: ca.SX) -> ca.SX:
    """The cubic through v0 at 0 and v1 at 1 with slopes d0 and d1 there."""
    rest, rise = 1 - at, v1 - v0
    return v0 + at * rise + at * rest * (rest * (d0 - rise) - at * (d1 - rise))


def _with_ballast(fixed: ca.SX, names: tuple[str, ...], share: ca.SX, by: By) -> ca.SX:
    """The robot's parameter vector with platform 2 changed by the ballast."""
    values = {name: fixed[i] for i, name in enumerate(names)}
    mass, distance, spread, low, high = ca.vertsplit(fixed[len(names) :])
    amount = low + share * (high - low)
    if by == "loads":
        m, I, c, a = (values[f"{symbol}2"] for symbol in ("m", "I", "c", "a"))
        values["m2"], values["I2"], reach = hang(m, I, c - a, (mass, distance, spread), amount)
        values["a2"] = c - reach
    else:
        values["I2"] = amount
    return ca.vertcat(*values.values())
