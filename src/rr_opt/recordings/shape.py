"""The platforms' shapes as the recording has them: a layout is measured by hand, markers are not.

Where the markers sit a millimetre from where the layout says, their residuals have a mean in the
platform's axes. Put right, the fit no longer jumps when a marker goes missing. Axes and origin stay
the layout's: the residuals of a least-squares fit have no mean shift or turn of a platform that
would not pull P apart.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.bodies import Bodies
from rr_opt.recordings.fit_noise import beyond, marker_noise
from rr_opt.recordings.rigid import Fit, fit

Array = NDArray[np.float64]

_ROUNDS = 25
_SAMPLE = 6000
"""Frames that are looked at, spread over the recording."""
_FEWEST = 20
"""Frames in which a marker must have been seen for its mean to be taken."""
_SURE = 5.0
"""Standard errors from which on a mean is no chance."""
_ENOUGH = 1.0
"""Standard errors that a round must move a marker by for another round; one alone corrects the part
of an error that the fit has not taken up."""


def refined(bodies: Bodies, seen: Array) -> tuple[Bodies, Array]:
    """The bodies with their markers where the recording has them, and by how much they moved.

    seen: (n, k, 2), m, labels put right. The shifts are (k, 2), m, in the platform's axes; zero
    where the layout was right within five standard errors.
    """
    now, seen = bodies, seen[:: max(1, len(seen) // _SAMPLE)]
    least = _SURE
    for _ in range(_ROUNDS):
        step, errors = _means(now, fit(now, seen))
        if not (np.hypot(*step.T) > least * errors).any():
            break
        now = replace(now, places=now.places + step)
        least = _ENOUGH
    shift = now.places - bodies.places
    return now, shift


def _means(bodies: Bodies, fitted: Fit) -> tuple[Array, Array]:
    """Mean residual of each marker in its platform's axes (k, 2), and its error (k,), m."""
    sigma = marker_noise(fitted)
    good = ~beyond(fitted, sigma) & (fitted.freedom > 0)
    shift, error = np.zeros_like(bodies.places), np.full(len(bodies.places), np.inf)
    for i, where in enumerate(bodies.platform):
        rows = good & np.isfinite(fitted.residual[:, i, 0])
        if rows.sum() < _FEWEST:
            continue
        turn = np.exp(-1j * fitted.heading[rows, where])
        own = (fitted.residual[rows, i, 0] + 1j * fitted.residual[rows, i, 1]) * turn
        shift[i] = np.median(own.real), np.median(own.imag)
        # A median of Gaussians has 1.25 times the error of their mean.
        error[i] = 1.25 * max(sigma, 1e-9) / np.sqrt(rows.sum())
    return shift, error
