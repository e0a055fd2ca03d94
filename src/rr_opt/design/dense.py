"""A gait's steady cycle on a mesh far finer than any program's: what a claim is worth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.setting import Setting, robot_of
from rr_opt.design.shapes.along import PATH, path_bounds
from rr_opt.design.solve import cycle_along
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.robot.gait import Gait

Array = NDArray[np.float64]

_SAMPLES = 1024
_NEAR_LIMIT = 0.97


@dataclass(frozen=True)
class Dense:
    """What is seen.

    speed   m/s, signed
    used    the largest share that it uses of a limit
    peaks   phases in [0, 1) at which the torque peaks near its limit
    checks  phases at which angle or rate do, where a shape checks these at some phases
    """

    speed: float
    used: float
    peaks: Array
    checks: Array


def dense(setting: Setting, gait: Gait, share: float) -> Dense:
    """Look at a gait finely."""
    smooth = gait.pieces == 1
    if setting.landscape.linear and smooth:
        cycle = cycle_along(setting.landscape, gait, share, _SAMPLES)
        speed, torque = float(cycle.speed[0]), cycle.torque[:, 0]
    else:
        steps = 4 * gait.pieces * -(-_SAMPLES // gait.pieces)
        steady = steady_cycle(robot_of(setting, share), gait, steps=steps)
        speed, torque = steady.speed, steady.torque[:-1]
    used, peaks = _peaks(np.abs(torque / setting.problem.limits.torque), smooth)
    checks = np.zeros(0)
    for shares in _path_shares(setting, gait):
        height, at = _peaks(np.abs(shares), smooth)
        used, checks = max(used, height), np.append(checks, at)
    return Dense(speed, used, peaks, checks)


def _path_shares(setting: Setting, gait: Gait) -> list[Array]:
    """Shares that phi, phi - phi0 and dphi/dt use of their bounds, where its shape checks these."""
    if gait.shape != "fourier":
        return []
    t = np.arange(_SAMPLES) / _SAMPLES * gait.period
    phi, bounds = gait.angle(t), path_bounds(setting.problem)
    used = {"angle": phi, "swing": phi - gait.offset, "rate": gait.rate(t)}
    return [used[name] / bounds[name].high for name in PATH]


def _peaks(size: Array, smooth: bool) -> tuple[float, Array]:
    """The height of the largest peak, and the phases of those that come near a share of 1."""
    left, right = np.roll(size, 1), np.roll(size, -1)
    at = np.flatnonzero((size >= left) & (size > right))
    height, shift = size[at], np.zeros(len(at))
    if smooth:
        # Vertex of the parabola through a peak and its neighbours.
        bend = left[at] - 2 * size[at] + right[at]
        slope = 0.5 * (left[at] - right[at])
        shift = np.where(bend < 0, slope / np.where(bend < 0, bend, -1.0), 0.0)
        height = height - 0.5 * slope * shift
    near = height > _NEAR_LIMIT
    return float(height.max(initial=0.0)), (at[near] + shift[near]) / len(size) % 1.0
