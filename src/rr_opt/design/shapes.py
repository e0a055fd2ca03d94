"""Shapes of gaits: what each adds to the unknowns and rows of multiple shooting.

phi is a function of the phase theta alone, given the shape's decisions and, for a shape that is not
a single formula, unknowns at every node. Rates are in radians per period, so that a shape does not
depend on the period. A shape is hashable, as programs are cached by shape:

    decisions    unknowns of the whole period, besides period, ballast and turn
    states       unknowns at every node that an interval propagates to the next
    controls     unknowns at every node, constant over the interval that begins there
    integrals    means of `integrands` over the period, needed by rows and bounds
    limits       rows that hold once a period: `limit_rows`
    path         rows at every node: `path_rows`, of the interval from theta, at one point
    checks       number of parameters, such as phases, that `limits` depend on: `given`
    angle        phi, dphi/dtheta, d2phi/dtheta2 (rad) at phase theta, `since` after the node
    bounds       intervals of these unknowns, and of rows, by name; those not named are free
    start, gait  the unknowns of a gait, or an approximation of it, and the gait of a solution
    prices, bound_prices  speed gained per unit of the limits on rate, angle and singularity, and
                 per unit by which an active bound of amplitude or offset moves up
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import decisions, reach_before_singularity
from rr_opt.model.gait import FourierGait, FreeGait, Gait
from rr_opt.model.problem import GaitBounds, Interval, Problem

Symbols = Mapping[str, Any]
Values = Mapping[str, Any]

TURN = 2 * math.pi
GRID = 16
"""Phases of the regular grid per harmonic."""
PATH = ("angle", "swing", "rate")
"""phi, phi - phi0 and dphi/dt."""


def path_bounds(problem: Problem) -> dict[str, Interval]:
    """Bounds of PATH. The singularity margin is a bound on the angle too."""
    limits = problem.limits
    reach = min(limits.angle, reach_before_singularity(problem.robot, limits.singularity))
    most = {"angle": reach, "swing": problem.gait.amplitude.high, "rate": limits.rate}
    return {name: Interval(-end, end) for name, end in most.items()}


class _Priced:
    """Common to the shapes: bounds and prices of the angle and its rate."""

    def _along(self, multipliers: Values) -> dict[str, Array]:
        """All multipliers of each of PATH."""
        raise NotImplementedError

    def offset_bounds(self, problem: Problem) -> Interval:
        """The problem's bounds, collapsed to a point where its limits leave no room."""
        box = decisions(problem)
        return box.offset if box.offset.fixed else problem.gait.offset

    def prices(self, problem: Problem, multipliers: Values) -> dict[str, float]:
        """Speed gained per unit of the limits on rate, angle and singularity."""
        limits, robot, along = problem.limits, problem.robot, self._along(multipliers)
        rate, angle = (float(np.abs(along[name]).sum()) for name in ("rate", "angle"))
        edge = reach_before_singularity(robot, limits.singularity)
        if limits.angle <= edge:
            return {"rate": rate, "angle": angle, "singularity": 0.0}
        # c1 cos(edge) + c2 = margin, so a wider margin reduces the edge.
        closer = 1 / (robot.platform1.c * math.sin(edge))
        return {"rate": rate, "angle": 0.0, "singularity": -angle * closer}

    def bound_prices(self, on_bounds: Values, multipliers: Values) -> dict[str, float]:
        """Speed gained per unit by which the active bound moves up: the largest amplitude bounds
        the swing, the least amplitude the first harmonic."""
        first = float(on_bounds["sine1"] if "sine1" in on_bounds else multipliers["first"])
        most = float(np.abs(self._along(multipliers)["swing"]).sum())
        amplitude = most if most > abs(first) else first
        return {"amplitude": amplitude, "offset": float(on_bounds["offset"])}


@dataclass(frozen=True)
class FourierShape(_Priced):
    """phi = offset + sum over n of sine_n sin(2 pi n theta) + cosine_n cos(2 pi n theta).

    cosine_1 is 0: this fixes the phase at which the period begins, which is otherwise arbitrary.

    Limits on angle and rate hold at the checked phases only, and the solver moves the peaks in
    between. So the phases at which a solution violates a limit are added to the checked ones, and
    none is removed, until no violation is left.
    """

    harmonics: int

    states = controls = integrals = path = ()

    @property
    def checks(self) -> int:
        """Those of the regular grid, and as many for added ones."""
        return 2 * GRID * self.harmonics

    @property
    def limits(self) -> tuple[str, ...]:
        """PATH at every checked phase."""
        return tuple(f"{name}{k}" for name in PATH for k in range(self.checks))

    @property
    def decisions(self) -> tuple[str, ...]:
        """Offset and coefficients."""
        return ("offset", *(name for name, _, _ in self._terms))

    @property
    def _terms(self) -> list[tuple[str, int, Any]]:
        """Name, harmonic n, and basis function."""
        sines = [(f"sine{n}", n, ca.sin) for n in range(1, self.harmonics + 1)]
        return sines + [(f"cosine{n}", n, ca.cos) for n in range(2, self.harmonics + 1)]

    def angle(self, z: Symbols, local: Symbols, theta: Any, since: Any) -> tuple[Any, Any, Any]:
        """phi and its derivatives in theta."""
        derivatives = [z["offset"], 0.0, 0.0]
        for name, n, wave in self._terms:
            for order in range(3):
                turned = TURN * n * theta + order * math.pi / 2
                derivatives[order] += z[name] * (TURN * n) ** order * wave(turned)
        phi, rate, acceleration = derivatives
        return phi, rate, acceleration

    def integrands(self, phi: Any, theta: Any) -> tuple[Any, ...]:
        """None."""
        return ()

    def limit_rows(self, z: Symbols, means: Symbols, checks: tuple[Any, ...]) -> tuple[Any, ...]:
        """phi, phi - phi0 and dphi/dt at the checked phases."""
        seen = [self.angle(z, {}, theta, 0.0) for theta in checks]
        return (
            *(phi for phi, _, _ in seen),
            *(phi - z["offset"] for phi, _, _ in seen),
            *(rate / z["period"] for _, rate, _ in seen),
        )

    def path_rows(
        self, z: Symbols, local: Symbols, theta: Any, width: Any, at: Any
    ) -> tuple[Any, ...]:
        """None."""
        return ()

    def given(self, added: Array) -> Array:
        """The phases: a regular grid, and the latest of the added ones. Unused places refine part
        of the grid."""
        half = self.checks // 2
        grid = np.arange(half) / half
        return np.concatenate([grid, np.append(grid + 0.5 / half, added)[len(added) :]])

    def bounds(self, problem: Problem) -> tuple[dict[str, Interval], dict[str, Interval]]:
        """The first harmonic is bounded below by the least amplitude."""
        first = Interval(problem.gait.amplitude.low, math.inf)
        rows = {
            f"{name}{k}": interval
            for name, interval in path_bounds(problem).items()
            for k in range(self.checks)
        }
        return {"offset": self.offset_bounds(problem), "sine1": first}, rows

    def start(self, gait: Gait, phases: Array) -> dict[str, Any]:
        """Coefficients of a sine, or of a gait with fewer harmonics."""
        values = dict.fromkeys(self.decisions, 0.0)
        values["offset"] = gait.offset
        if isinstance(gait, FourierGait):
            for n, (sine, cosine) in enumerate(zip(gait.sines, gait.cosines, strict=True), 1):
                values[f"sine{n}"] = sine
                if n > 1:
                    values[f"cosine{n}"] = cosine
        else:
            values["sine1"] = gait.amplitude
        return values

    def gait(self, values: Values) -> FourierGait:
        """The gait of a solution."""
        sines, cosines = (
            tuple(float(values.get(f"{kind}{n}", 0.0)) for n in range(1, self.harmonics + 1))
            for kind in ("sine", "cosine")
        )
        return FourierGait(float(values["period"]), float(values["offset"]), sines, cosines)

    def _along(self, multipliers: Values) -> dict[str, Array]:
        return {
            name: np.array([multipliers[f"{name}{k}"] for k in range(self.checks)]) for name in PATH
        }


@dataclass(frozen=True)
class FreeShape(_Priced):
    """The servo's acceleration is the control, constant on each interval. Unknowns at every node:
    phi, its derivative in theta, and the second one from there on.

    phi is then quadratic in theta on every interval. It is bounded at the node and at one more
    point: where it is extreme, once that is known.

    The phase of the first harmonic is free. The mesh is fixed, so a gait shifted by a fraction of
    an interval is a different gait, and not in this family.
    """

    decisions = ("offset",)
    states = ("phi", "slope")
    controls = ("bend",)
    integrals = ("mean_angle", "first_sine", "first_cosine")
    limits = ("centred", "first")
    path = ("rate", *(f"{name}{k}" for name in ("angle", "swing") for k in (0, 1)))
    checks = 0

    def angle(self, z: Symbols, local: Symbols, theta: Any, since: Any) -> tuple[Any, Any, Any]:
        """phi and its derivatives in theta."""
        phi, slope, bend = (local[name] for name in ("phi", "slope", "bend"))
        return phi + since * (slope + since * bend / 2), slope + since * bend, bend

    def integrands(self, phi: Any, theta: Any) -> tuple[Any, ...]:
        """phi, and its projections onto the first harmonic."""
        return phi, 2 * phi * ca.sin(TURN * theta), 2 * phi * ca.cos(TURN * theta)

    def limit_rows(self, z: Symbols, means: Symbols, checks: tuple[Any, ...]) -> tuple[Any, ...]:
        """The offset as the mean angle; the size of the first harmonic."""
        first = ca.hypot(means["first_sine"], means["first_cosine"])
        return means["mean_angle"] - z["offset"], first

    def path_rows(
        self, z: Symbols, local: Symbols, theta: Any, width: Any, at: Any
    ) -> tuple[Any, ...]:
        """dphi/dt at the node, phi and phi - phi0 there and at the extra point."""
        both = [self.angle(z, local, theta, since)[0] for since in (0.0, at * width)]
        return local["slope"] / z["period"], *both, *(phi - z["offset"] for phi in both)

    def given(self, added: Array) -> Array:
        """None."""
        return np.zeros(0)

    def bounds(self, problem: Problem) -> tuple[dict[str, Interval], dict[str, Interval]]:
        """The first harmonic is bounded below by the least amplitude."""
        bounds, least = path_bounds(problem), problem.gait.amplitude.low
        rows = {name: bounds[name.rstrip("01")] for name in self.path}
        rows |= {"centred": Interval(0.0, 0.0), "first": Interval(least, math.inf)}
        return {"offset": self.offset_bounds(problem)}, rows

    def start(self, gait: Gait, phases: Array) -> dict[str, Any]:
        """Sampled at the nodes."""
        t = phases * gait.period
        phi, slope = gait.angle(t), gait.period * gait.rate(t)
        swing = 2 * (phi - phi.mean())
        return {
            "offset": gait.offset,
            "phi": phi,
            "slope": slope,
            "bend": (np.roll(slope, -1) - slope) * len(phases),
            "mean_angle": gait.offset,
            "first_sine": float(np.mean(swing * np.sin(TURN * phases))),
            "first_cosine": float(np.mean(swing * np.cos(TURN * phases))),
        }

    def gait(self, values: Values) -> FreeGait:
        """The gait of a solution."""
        period = float(values["period"])
        return FreeGait(
            period,
            float(values["phi"][0]),
            float(values["slope"][0]) / period,
            tuple((values["bend"] / period**2).tolist()),
        )

    def _along(self, multipliers: Values) -> dict[str, Array]:
        rows = {name: [row for row in self.path if row.startswith(name)] for name in PATH}
        return {name: np.concatenate([multipliers[r] for r in own]) for name, own in rows.items()}


Shape = FourierShape | FreeShape


def shape_of(gait: GaitBounds) -> Shape:
    """The shape of a problem that does not ask for a sine."""
    return FourierShape(gait.harmonics) if gait.shape == "fourier" else FreeShape()
