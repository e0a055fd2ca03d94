"""Several harmonics: limits on angle and rate hold at phases that are checked.

Held at a few phases alone, a limit is broken between them: the solver moves the peaks there. So
the phases at which an answer breaks limits are added to the checked ones, and none is taken away,
until the peaks have nowhere to go.
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
from rr_opt.model.gait import FourierGait, Gait
from rr_opt.model.problem import Interval, Problem

TURN = 2 * math.pi
GRID = 16
"""Phases of the regular grid for each harmonic."""


@dataclass(frozen=True)
class FourierShape:
    """phi = offset + sum over n of sine_n sin(2 pi n theta) + cosine_n cos(2 pi n theta).

    cosine_1 is 0: that says at which phase the period begins, which nothing else does.
    """

    harmonics: int

    states = controls = integrals = path = ()

    @property
    def checks(self) -> int:
        """Some for a regular grid, as many for what is added."""
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
        """Name, n, and the function that it multiplies."""
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

    def limit_rows(
        self, z: Symbols, means: Symbols, checks: tuple[Any, ...], c1: Any, c2: Any
    ) -> tuple[Any, ...]:
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

    def given(self, problem: Problem, added: Array) -> Array:
        """The phases: a regular grid, and the last of the added ones. As long as few are, the grid
        is twice as fine in part."""
        half = self.checks // 2
        grid = np.arange(half) / half
        return np.concatenate([grid, np.append(grid + 0.5 / half, added)[len(added) :]])

    def bounds(self, problem: Problem) -> Bounds:
        """The first harmonic is at least the least amplitude."""
        box, gait = decisions(problem), problem.gait
        offset = box.offset if box.offset.fixed else gait.offset
        first = Interval(gait.amplitude.low, math.inf)
        rows = {
            f"{name}{k}": interval
            for name, interval in path_bounds(problem).items()
            for k in range(self.checks)
        }
        return Bounds({"offset": offset, "sine1": first}, rows)

    def start(self, gait: Gait, phases: Array) -> dict[str, Any]:
        """Coefficients of a sine or of fewer harmonics."""
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

    def prices(self, problem: Problem, multipliers: Values) -> dict[str, float]:
        """From the rows at the checked phases."""
        return path_prices(problem, self._along(multipliers))

    def bound_prices(self, on_bounds: Values, multipliers: Values) -> dict[str, float]:
        """From the first harmonic, the swing and the offset."""
        amplitude = amplitude_price(on_bounds["sine1"], self._along(multipliers))
        return {"amplitude": amplitude, "offset": float(on_bounds["offset"])}

    def _along(self, multipliers: Values) -> dict[str, Array]:
        """Multipliers of PATH, one for each checked phase."""
        return {
            name: np.array([multipliers[f"{name}{k}"] for k in range(self.checks)]) for name in PATH
        }
