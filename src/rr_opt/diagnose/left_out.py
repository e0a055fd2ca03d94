"""Predict each fitted run from the others, without fitting again.

The linearised problems of the runs add up. Taking one out and solving gives the quantities that
the others would have given; at these, with a start of its own, the run is what it was not part of.
"""

from __future__ import annotations

import numpy as np

from rr_opt.diagnose.fit import Fit, bounded_step, box, doubt


def left_out(fit: Fit) -> float:
    """Misfit of the runs, each predicted from the others: mean square in sigma, less 1."""
    if len(fit.normals) < 2:
        return float("nan")
    u, (low, high) = fit.scaled, box(fit.quantities)
    prior = np.array([float(q.known) for q in fit.quantities]) * doubt(fit.cost, fit.count)
    total = 0.0
    for piece, own in fit.normals.items():
        others = [n for other, n in fit.normals.items() if other != piece]
        g = sum((n.g for n in others), prior * u)
        H = sum((n.H for n in others), np.diag(prior))
        d = bounded_step(H, g, 1e-9, u, low, high) if u.size else u
        total += own.at(d)
    starts = sum(normal.shift.size for normal in fit.normals.values())
    return total / max(fit.count - starts, 1) - 1.0
