"""No given shape: the servo's acceleration is the control, constant on each interval.

phi is then a quadratic in theta on every interval. It is bounded at the node and at one more place:
where it is extreme, once that is known.

At which phase the first harmonic begins is open. The intervals are where they are, so a gait moved
along them by a part of one is another gait, and not one of these.
"""

import math
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import decisions
from rr_opt.design.shapes.shape import (
    PATH,
    Bounds,
    Symbols,
    Values,
    amplitude_price,
    path_bounds,
    path_prices,
)
from rr_opt.model.gait import FreeGait, Gait
from rr_opt.model.problem import Interval, Problem

TURN = 2 * math.pi


@dataclass(frozen=True)
class FreeShape:
    """Unknowns at every node: phi, its derivative in theta, and the second one from there on."""

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
        """phi, and what projects it on the first harmonic."""
        return phi, 2 * phi * ca.sin(TURN * theta), 2 * phi * ca.cos(TURN * theta)

    def limit_rows(
        self, z: Symbols, means: Symbols, checks: tuple[Any, ...], c1: Any, c2: Any
    ) -> tuple[Any, ...]:
        """The offset is the mean angle; the size of the first harmonic."""
        first = ca.hypot(means["first_sine"], means["first_cosine"])
        return means["mean_angle"] - z["offset"], first

    def path_rows(
        self, z: Symbols, local: Symbols, theta: Any, width: Any, at: Any
    ) -> tuple[Any, ...]:
        """dphi/dt at the node, phi and phi - phi0 there and at the place."""
        both = [self.angle(z, local, theta, since)[0] for since in (0.0, at * width)]
        return local["slope"] / z["period"], *both, *(phi - z["offset"] for phi in both)

    def given(self, problem: Problem, added: Array) -> Array:
        """None."""
        return np.zeros(0)

    def bounds(self, problem: Problem) -> Bounds:
        """The first harmonic is at least the least amplitude."""
        box, gait, bounds = decisions(problem), problem.gait, path_bounds(problem)
        rows = {name: bounds[name.rstrip("01")] for name in self.path}
        rows |= {"centred": Interval(0.0, 0.0), "first": Interval(gait.amplitude.low, math.inf)}
        return Bounds({"offset": box.offset if box.offset.fixed else gait.offset}, rows)

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

    def prices(self, problem: Problem, multipliers: Values) -> dict[str, float]:
        """From the rows at the nodes."""
        return path_prices(problem, self._along(multipliers))

    def bound_prices(self, on_bounds: Values, multipliers: Values) -> dict[str, float]:
        """From the first harmonic, the swing and the offset."""
        amplitude = amplitude_price(multipliers["first"], self._along(multipliers))
        return {"amplitude": amplitude, "offset": float(on_bounds["offset"])}

    def _along(self, multipliers: Values) -> dict[str, Array]:
        """Multipliers of PATH, all of each."""
        rows = {name: [row for row in self.path if row.startswith(name)] for name in PATH}
        return {name: np.concatenate([multipliers[r] for r in own]) for name, own in rows.items()}
