"""scipy alone: SLSQP over the gait, each evaluation the steady cycle by `solve_ivp`.

Slopes are SLSQP's own differences. The torque is held at 128 phases.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import minimize

from benchmarks.optimise.peers.posed import Array, Claim, Posed
from benchmarks.optimise.peers.simulated import Steady, steady

NAME = "scipy SLSQP + solve_ivp"
_SAMPLES, _RTOL = 128, 1e-9


def prepare(posed: Posed) -> Callable[[Array], Claim]:
    """The solver of a problem."""
    free = np.flatnonzero(posed.least < posed.most)
    low, span = posed.least[free], (posed.most - posed.least)[free]

    def solve(start: Array) -> Claim:
        known: dict[bytes, Steady] = {}

        def gait(z: Array) -> Array:
            full = start.copy()
            full[free] = low + span * z
            return full

        def cycle(z: Array) -> Steady:
            if z.tobytes() not in known:
                known.clear()
                known[z.tobytes()] = steady(posed, gait(z), _SAMPLES, _RTOL)
            return known[z.tobytes()]

        def margins(z: Array) -> Array:
            amplitude, period, offset, _ = gait(z)
            rows = [posed.reach - amplitude - offset, posed.reach - amplitude + offset]
            if np.isfinite(posed.rate):
                rows.append(posed.rate * period / (2 * np.pi) - amplitude)
            torque = cycle(z).torque / posed.torque
            return np.concatenate([rows, 1 - torque, 1 + torque])

        found = minimize(
            lambda z: -abs(cycle(z).velocity),
            (start[free] - low) / span,
            method="SLSQP",
            bounds=[(0.0, 1.0)] * len(free),
            constraints={"type": "ineq", "fun": margins},
            options={"ftol": 1e-9, "maxiter": 100},
        )
        return Claim.of(gait(found.x), -float(found.fun), bool(found.success))

    return solve
