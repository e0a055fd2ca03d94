"""The circles of a robot's gaits: curvature and speed over offset, amplitude and period."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.dynamics import dynamics_of
from rr_opt.problem import Problem
from rr_opt.verify.evaluate import Mask
from rr_opt.verify.grid import reach
from rr_opt.verify.speeds import least_S1, speeds

Array = NDArray[np.float64]

_SLACK = 1e-8
_TOLERANCE = 1e-6


@dataclass(frozen=True)
class TurnMap:
    """Gaits at offsets phi0 >= 0; those at -phi0 are mirror images, if the robot is two-sided.

    amplitude (A,), offset (F,) in rad, period (T,) in s; all others (A, T, F): speed (m/s, signed),
    heading per period (rad, positive to the left), peak torque (N m), keeps: every limit is kept
    """

    amplitude: Array
    period: Array
    offset: Array
    speed: Array
    heading: Array
    peak_torque: Array
    keeps: Mask
    two_sided: bool = True

    @property
    def curvature(self) -> Array:
        """Heading per metre of the mean circle, 1/m; NaN where there is no steady cycle."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.heading / (self.period[:, None] * np.abs(self.speed))


def open_offsets(problem: Problem) -> float:
    """The largest offset that the limits, the least amplitude and the problem's own bounds on it
    allow, rad; bounds of one value count as open."""
    box = problem.gait.offset
    own = math.inf if box.fixed else max(abs(box.low), abs(box.high))
    return min(reach(problem) - problem.gait.amplitude.low, own, math.pi)


def turn_map(problem: Problem, counts: tuple[int, int, int]) -> TurnMap:
    """The map of the robot as it is, at so many amplitudes, periods and offsets within bounds."""
    box, limits = problem.gait, problem.limits
    most = min(box.amplitude.high, reach(problem), limits.rate * box.period.high / (2 * math.pi))
    amplitude = np.linspace(box.amplitude.low, most, counts[0] if most > box.amplitude.low else 1)
    ends = (box.period.low, box.period.high)
    period = np.geomspace(*ends, counts[1]) if ends[0] < ends[1] else np.array(ends[:1])
    offset = np.linspace(0.0, open_offsets(problem), counts[2])
    alpha, phi0, T = np.meshgrid(amplitude, offset, period, indexing="ij")
    far = alpha + phi0
    inside = (far <= limits.angle * (1 + _SLACK)) & (
        least_S1(problem.robot, alpha, phi0) >= limits.singularity * (1 - _SLACK)
    )
    seen = speeds(
        problem,
        np.where(inside, alpha, 0.0)[..., :1],
        period,
        np.where(inside, phi0, 0.0)[..., :1],
        None,
        _TOLERANCE,
    )
    keeps = (
        inside
        & seen.converged
        & (alpha > 0)
        & (alpha * 2 * math.pi <= limits.rate * T * (1 + _SLACK))
        & (seen.peak_torque <= limits.torque * (1 + _SLACK))
    )
    keeps &= ahead(problem, seen.speed)
    parts = (np.where(inside, part, np.nan) for part in (seen.speed, seen.turn, seen.peak_torque))
    speed, heading, torque = (np.swapaxes(part, 1, 2) for part in parts)
    keeps, alike = np.swapaxes(keeps, 1, 2), dynamics_of(problem.robot).mirrored
    return TurnMap(amplitude, period, offset, speed, heading, torque, keeps, alike)


def ahead(problem: Problem, speed: Array) -> Mask:
    """Where it drives the way it should."""
    ways = {"forward": speed > 0, "backward": speed < 0, "either": np.isfinite(speed)}
    return ways[problem.direction]
