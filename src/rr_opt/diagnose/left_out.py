"""Predict each fitted run from the others, without fitting again.

The linearised problems of the runs add up. Taking one out and solving gives the quantities that
the others would have given; at these, with a start of its own, the run is what it was not part of.
"""

from __future__ import annotations

from rr_opt.diagnose.fit import Fit
from rr_opt.diagnose.normal import bounded_step, total
from rr_opt.diagnose.problem import box


def left_out(fit: Fit) -> float:
    """Misfit of the runs, each predicted from the others: mean square in sigma, less 1."""
    if len(fit.normals) < 2:
        return float("nan")
    u, (low, high) = fit.scaled, box(fit.quantities)
    left = 0.0
    for piece, own in fit.normals.items():
        others = [n for other, n in fit.normals.items() if other != piece]
        rest = total(others, fit.prior, u)
        d = bounded_step(rest.H, rest.g, 1e-9, u, low, high) if u.size else u
        left += own.at(d)
    starts = sum(normal.shift.size for normal in fit.normals.values())
    return left / max(fit.count - starts, 1) - 1.0
