"""How the measured angle may leave its command: smooth deviations, and whether there are any.

Harmonics of the cycle, a slow change of the first of them, and what a start from rest adds in the
first period.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import chi2

from rr_opt.diagnose.model import Array, Data
from rr_opt.diagnose.racer import RollerRacer
from rr_opt.diagnose.stages.splines import columns
from rr_opt.physics.drive import told

HARMONICS = 8
_TRANSIENT = 6
_FOLLOW = 1e-3
"""Above this chance of noise alone the angle is its command."""


def deviates(model: RollerRacer, runs: Sequence[int]) -> bool:
    """Whether the angle is not its command in these runs, together.

    If it is, no more is to be known of it: the motion of half a minute depends on the angle more
    finely than the angle can be measured.
    """
    worth, dof = 0.0, 0
    for run in runs:
        here, data = model.experiment.runs[run], model.runs[run]
        rest = here.start == "rest"
        wiggle = wiggles(data.t, here.gait.period, rest)[0]
        _, own, rank = deviation(wiggle, data, told(here.gait, rest).at(data.t)[0])
        worth, dof = worth + own, dof + rank
    return bool(chi2.sf(worth, dof) < _FOLLOW)


def deviation(wiggle: Array, data: Data, command: Array) -> tuple[Array, float, int]:
    """Coefficients of the deviation, the chi-square that they explain, and their number."""
    off = (data.values[:, 3] - command) / data.sigma[:, 3]
    seen = np.isfinite(off)
    W, y = wiggle[seen] / data.sigma[seen, 3, None], off[seen]
    beta, _, rank, _ = np.linalg.lstsq(W, y, rcond=None)
    return np.asarray(beta, float), float(y @ y - np.sum((y - W @ beta) ** 2)), int(rank)


def wiggles(t: Array, period: float, rest: bool) -> tuple[Array, Array, Array]:
    """The deviations of the angle (n, nb), and their first and second derivatives."""
    omega = 2 * np.pi / period
    k = omega * np.arange(1, HARMONICS + 1)
    c, s = np.cos(np.outer(t, k)), np.sin(np.outer(t, k))
    one, zero = np.ones((t.size, 1)), np.zeros((t.size, 1))
    slow = ((t - t.mean()) / (t[-1] - t[0]))[:, None]
    d = 1 / (t[-1] - t[0])
    c1, s1, w = c[:, :1], s[:, :1], omega
    value = [one, c, s, slow, slow * c1, slow * s1]
    first = [zero, -k * s, k * c, d * one, d * c1 - w * slow * s1, d * s1 + w * slow * c1]
    second = [
        *(zero, -k * k * c, -k * k * s, zero),
        *(-2 * d * w * s1 - w * w * slow * c1, 2 * d * w * c1 - w * w * slow * s1),
    ]
    if rest:
        early = t - t[0] <= period
        B, dB = columns(t[early], period / _TRANSIENT)
        # The last three would not fade out at the end of the period.
        m = B.shape[1] - 3
        for parts, own in ((value, B), (first, dB), (second, np.gradient(dB, t[early], axis=0))):
            part = np.zeros((t.size, m))
            part[early] = own[:, :m]
            parts.append(part)
    return np.hstack(value), np.hstack(first), np.hstack(second)
