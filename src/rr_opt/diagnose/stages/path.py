"""A path near what was recorded, about which every stage is linear.

It follows the data and not the model, so that a fault of any size leaves the linearisation good.
The angle is the command, or where that is not what was measured, the command and a smooth
deviation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from rr_opt.diagnose.model import Array
from rr_opt.diagnose.racer import RollerRacer
from rr_opt.diagnose.stages.angle import deviation, wiggles
from rr_opt.diagnose.stages.splines import columns, smooth
from rr_opt.physics.drive import told

KNOTS_IN_PERIOD = 8


@dataclass(frozen=True)
class Path:
    """The path of a run; n samples, times in s, SI.

    phase    of the command, 0 to 1;  told (3, n) the command and its derivatives
    wiggle   (n, nw) deviations that the angle may have;  drive (3, n) phi, dphi, ddphi
    free     (n, nb) those that it has, free_rate theirs: all, or none if it keeps its command
    pose     (n, 3) x, y, psi;  v (n,) speed of P along platform 1
    data     (n, 4) recorded, sigma (n, 4), NaN where there is nothing
    """

    run: int
    t: Array
    period: float
    rest: bool
    phase: Array
    told: Array
    wiggle: Array
    free: Array
    free_rate: Array
    drive: Array
    pose: Array
    v: Array
    data: Array
    sigma: Array


def path(model: RollerRacer, run: int, predicted: Array, *, follow: bool) -> Path:
    """The path of a run.

    predicted  (n, 4) by a fit of the parameters: where it does as well as the data allow, the path
               is that, and has no noise of its own, which the squares of noise would bias
    follow     whether the angle is what was measured, or the command
    """
    here, data = model.experiment.runs[run], model.runs[run]
    t, period, rest = data.t, here.gait.period, here.start == "rest"
    command = told(here.gait, rest).at(t)
    wiggle, rate, bend = wiggles(t, period, rest)
    beta = np.zeros(wiggle.shape[1])
    if follow:
        beta = deviation(wiggle, data, command[0])[0]
    drive = command + np.array([wiggle @ beta, rate @ beta, bend @ beta])
    B, dB = columns(t, max(period / KNOTS_IN_PERIOD, 4 * float(np.median(np.diff(t)))))
    sigma = np.nanmedian(data.sigma[:, :3], axis=0)
    C = smooth(B, (data.values[:, :3] - predicted[:, :3]) / sigma) * sigma
    pose = predicted[:, :3] + B @ C
    moving = CubicSpline(t, predicted[:, :3]).derivative()(t) + dB @ C
    v = moving[:, 0] * np.cos(pose[:, 2]) + moving[:, 1] * np.sin(pose[:, 2])
    free, free_rate = (part if follow else part[:, :0] for part in (wiggle, rate))
    return Path(
        run, t, period, rest, t / period % 1.0, command, wiggle, free, free_rate, drive, pose, v,
        data.values, data.sigma,
    )  # fmt: skip
