"""The sine: its extremes are known, so its limits are rows that hold once a period."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import decisions
from rr_opt.design.shapes.shape import Bounds, Symbols, Values
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import Interval, Problem
from rr_opt.model.servo_command import LinearServo

TURN = 2 * math.pi


@dataclass(frozen=True)
class SineShape:
    """phi = offset + amplitude sin(2 pi theta)."""

    decisions = ("amplitude", "offset")
    states = controls = integrals = path = ()
    limits = ("rate", "angle+", "angle-", "singularity+", "singularity-", "command")
    checks = 2

    def angle(self, z: Symbols, local: Symbols, theta: Any, since: Any) -> tuple[Any, Any, Any]:
        """phi and its derivatives in theta."""
        swing = z["amplitude"] * ca.sin(TURN * theta)
        return (
            swing + z["offset"],
            z["amplitude"] * TURN * ca.cos(TURN * theta),
            -(TURN**2) * swing,
        )

    def integrands(self, phi: Any, theta: Any) -> tuple[Any, ...]:
        """None."""
        return ()

    def limit_rows(
        self, z: Symbols, means: Symbols, checks: tuple[Any, ...], c1: Any, c2: Any
    ) -> tuple[Any, ...]:
        """Peak rate, peak angle on either side, least S1 on either side, and the amplitude that the
        servo is told; checks: its tau and beta."""
        high, low = z["offset"] + z["amplitude"], z["offset"] - z["amplitude"]
        return (
            TURN * z["amplitude"] / z["period"],
            high,
            -low,
            c1 * ca.cos(high) + c2,
            c1 * ca.cos(low) + c2,
            z["amplitude"] / LinearServo(*checks).gain(z["period"]),
        )

    def path_rows(self, z: Symbols, local: Symbols, theta: Any, width: Any) -> tuple[Any, ...]:
        """None."""
        return ()

    def given(self, problem: Problem, added: Array) -> Array:
        """tau and beta of the servo."""
        servo = problem.command.servo if problem.command else LinearServo()
        return np.array([servo.tau, servo.beta])

    def bounds(self, problem: Problem) -> Bounds:
        """Where limits and bounds leave one value there is no inside for the solver to move in:
        the decision is fixed, and rows that then depend on nothing free are dropped."""
        box, gait, limits = decisions(problem), problem.gait, problem.limits
        low = gait.amplitude.low
        amplitude = Interval(low, low) if box.amplitude_pinned else gait.amplitude
        offset = box.offset if box.offset.fixed else gait.offset
        period = box.period if box.period.fixed else gait.period
        rows = {}
        if not (amplitude.fixed and period.fixed):
            rows["rate"] = Interval(-math.inf, limits.rate)
        if not (amplitude.fixed and offset.fixed):
            for side in "+-":
                rows[f"angle{side}"] = Interval(-math.inf, limits.angle)
                rows[f"singularity{side}"] = Interval(limits.singularity, math.inf)
        if problem.command and problem.bounds_command and not amplitude.fixed:
            rows["command"] = problem.command.amplitude
        return Bounds({"amplitude": amplitude, "offset": offset}, rows)

    def start(self, gait: Gait, phases: Array) -> dict[str, Any]:
        """Amplitude and offset."""
        return {"amplitude": gait.amplitude, "offset": gait.offset}

    def gait(self, values: Values) -> SineGait:
        """The gait of a solution."""
        return SineGait(*(float(values[name]) for name in ("amplitude", "period", "offset")))

    def prices(self, problem: Problem, multipliers: Values) -> dict[str, float]:
        """Each row is bounded by the limit of its name, so its multiplier is the price."""
        return {
            "rate": float(multipliers["rate"]),
            **{
                name: float(multipliers[f"{name}+"] + multipliers[f"{name}-"])
                for name in ("angle", "singularity")
            },
        }

    def bound_prices(self, on_bounds: Values, multipliers: Values) -> dict[str, float]:
        """From the bounds of the decisions, or of the command."""
        prices = {name: float(on_bounds[name]) for name in self.decisions}
        return prices | {"amplitude": prices["amplitude"] + float(multipliers["command"])}
