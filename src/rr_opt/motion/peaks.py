"""Peaks of a steady cycle between its samples."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from rr_opt.motion.steady_cycle import SteadyCycle

BETWEEN = 16
"""Points among which a peak is looked for, for each sample of the cycle."""


def peak_torque(steady: SteadyCycle) -> float:
    """Largest |torque|, N m: a spline on each piece, from just after a jump to just before the
    next."""
    pieces = steady.gait.pieces
    each = (len(steady.t) - 1) // pieces
    inside = steady.torque[:-1].reshape(pieces, each)
    ends = steady.torque_before[each::each, None]
    at = np.arange(each + 1)
    spline = CubicSpline(at, np.hstack([inside, ends]), axis=1)
    return float(np.abs(spline(np.linspace(0, each, BETWEEN * each + 1))).max())
