"""No given shape: the servo's acceleration is the control, constant on each interval.

phi is then a quadratic in theta on every interval, and stays within the triangle of its ends and
the point where the tangents at them meet. That point is (phi + width/2 dphi/dtheta) at the node;
with equal widths a node lies halfway between two such points. So a bound on them bounds phi
everywhere and not at nodes alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import decisions
from rr_opt.design.shapes.shape import (
    PATH,
    ZERO,
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
    limits = ("centred",)
    path = PATH
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
        """The offset is the mean angle."""
        return (means["mean_angle"] - z["offset"],)

    def path_rows(self, z: Symbols, local: Symbols, theta: Any, width: Any) -> tuple[Any, ...]:
        """phi and phi - phi0 where the tangents meet, and dphi/dt at the node."""
        peak = local["phi"] + width / 2 * local["slope"]
        return peak, peak - z["offset"], local["slope"] / z["period"]

    def given(self, problem: Problem, added: Array) -> Array:
        """None."""
        return np.zeros(0)

    def bounds(self, problem: Problem) -> Bounds:
        """The first harmonic is at least the least amplitude, and begins at phase 0."""
        box, gait = decisions(problem), problem.gait
        unknowns = {
            "offset": box.offset if box.offset.fixed else gait.offset,
            "first_sine": Interval(gait.amplitude.low, math.inf),
            "first_cosine": ZERO,
        }
        return Bounds(unknowns, {**path_bounds(problem), "centred": ZERO})

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
        return path_prices(problem, multipliers)

    def bound_prices(self, on_bounds: Values, multipliers: Values) -> dict[str, float]:
        """From the first harmonic, the swing and the offset."""
        amplitude = amplitude_price(on_bounds["first_sine"], multipliers)
        return {"amplitude": amplitude, "offset": float(on_bounds["offset"])}
