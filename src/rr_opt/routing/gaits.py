"""The fastest gait for each curvature: a chart of steady gaits, and the effect of coasting."""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.integrate import solve_ivp

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.verify.grid import reach
from rr_opt.verify.speeds import motions, speeds

Way = Literal["forward", "backward"]

_PERIODS, _RATES, _OFFSETS, _PHASES = 8, 8, 81, 64
_ROUNDING = 1e-9
_TRIES, _NEAR = 20, 0.05


@dataclass(frozen=True)
class Chart:
    """Feasible steady gaits in one direction: rows of gaits that differ in their offset alone. All
    (rows, offsets): gaits (3, ...) with amplitude (rad), offset (rad) and period (s); speed (m/s,
    above 0); curvature (1/m, positive to the left); NaN where there is no gait."""

    problem: Problem
    way: Way
    gaits: Array
    speed: Array
    curvature: Array

    def fastest(self, curvature: float) -> tuple[SineGait, float] | None:
        """The fastest gait on a circle, interpolated in the chart, and its speed, m/s."""
        below = self.curvature - curvature
        before, after = below[:, :-1], below[:, 1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            share = before / (before - after)
            speed = self.speed[:, :-1] * (1 - share) + self.speed[:, 1:] * share
            speed = np.where((share >= 0) & (share <= 1), speed, 0.0)
        for _ in range(_TRIES):
            i, j = np.unravel_index(np.argmax(speed), speed.shape)
            if speed[i, j] == 0:
                return None
            ends = self.gaits[:, i, j : j + 2]
            amplitude, offset, period = map(float, ends @ [1 - share[i, j], share[i, j]])
            # Where a gait spins on the spot the curvature changes sign through infinity.
            seen = speeds(self.problem, amplitude, period, offset, None, 1e-4)
            made = float(seen.turn) / (period * abs(float(seen.speed)))
            if abs(made - curvature) <= _NEAR * (abs(curvature) + self.widest):
                return SineGait(amplitude, period, offset), float(speed[i, j])
            speed[i, j] = 0.0
        return None

    @property
    def widest(self) -> float:
        """The curvature of a circle as wide as the robot is long, 1/m."""
        robot = self.problem.robot
        return 1 / (robot.platform1.c + robot.platform2.c)

    def cost(self, curvature: float) -> float:
        """Time per metre, s/m, at a curvature; inf where no gait reaches it."""
        found = self.fastest(curvature)
        return 1 / found[1] if found else math.inf

    @property
    def tightest(self) -> tuple[float, float]:
        """The range of curvatures for which there are gaits, 1/m."""
        if not np.isfinite(self.curvature).any():
            return 0.0, 0.0
        return float(np.nanmin(self.curvature)), float(np.nanmax(self.curvature))


def chart(problem: Problem, way: Way) -> Chart:
    """The chart of a problem's robot, with the offset free as far as the limits allow."""
    box, limits = problem.gait, problem.limits
    room = reach(problem)
    parts = []
    for period in np.unique(np.geomspace(box.period.low, box.period.high, _PERIODS)):
        most = min(limits.rate * period / (2 * math.pi), box.amplitude.high, room)
        if most < box.amplitude.low:
            continue
        amplitude = np.linspace(max(box.amplitude.low, most / _RATES), most, _RATES)[:, None]
        offset = (room - amplitude) * np.linspace(-1, 1, _OFFSETS)
        seen = speeds(problem, amplitude, period, offset, None, 1e-4)
        sign = 1 if way == "forward" else -1
        kept = seen.converged & (sign * seen.speed > 0)
        kept &= seen.peak_torque <= limits.torque * (1 + _ROUNDING)
        if math.isfinite(limits.grip):
            own = np.broadcast_arrays(amplitude, period, offset, np.nan)
            needed = motions(problem, np.stack([part[kept] for part in own]), _PHASES, grip=True)
            kept[kept] = np.abs(needed.grips).max(axis=(0, 1)) <= limits.grip
        with np.errstate(divide="ignore", invalid="ignore"):
            curvature = seen.turn / (period * np.abs(seen.speed))
        speed, curvature = (np.where(kept, x, np.nan) for x in (np.abs(seen.speed), curvature))
        rows = np.broadcast_arrays(amplitude, offset, period, speed, curvature)
        parts.append(np.stack(rows))
    if not parts:
        return Chart(problem, way, np.zeros((3, 1, 2)), *np.full((2, 1, 2), np.nan))
    whole = np.concatenate(parts, axis=1)
    return Chart(problem, way, whole[:3], *whole[3:])


@dataclass(frozen=True)
class Coasting:
    """The joint held straight: time, s, and distance, m, until the speed counts as rest."""

    seconds: float
    distance: float


_LONGEST = 600.0


def coasting(problem: Problem, speed: float, rest: float) -> Coasting:
    """From a speed of axle 1, m/s, signed, to one that counts as rest; at most ten minutes."""
    if abs(speed) <= rest:
        return Coasting(0.0, 0.0)
    dynamics = dynamics_of(problem.robot)
    p = dynamics.values(problem.robot)

    def slope(_: float, state: Array) -> list[float]:
        return [float(dynamics.motion(state[0], 0, 0, 0, p)[0]), abs(state[0])]

    def slow(_: float, state: Array) -> float:
        return abs(state[0]) - rest

    slow.terminal = True  # pyright: ignore[reportFunctionMemberAccess] - as solve_ivp wants it
    out = solve_ivp(slope, (0, _LONGEST), [speed, 0.0], events=slow, rtol=1e-8, atol=1e-10)
    return Coasting(float(out.t[-1]), float(out.y[1, -1]))


_RELAXED = 1.5


def binding_limits(problem: Problem, way: Way, curvature: float) -> list[str]:
    """The limits of which any one, relaxed by half, makes a circle drivable."""
    limits, box = problem.limits, problem.gait
    wider = {
        name: replace(problem, limits=replace(limits, **{name: getattr(limits, name) * _RELAXED}))
        for name in ("angle", "rate", "torque", "grip")
    }
    wider["singularity"] = replace(
        problem, limits=replace(limits, singularity=limits.singularity / _RELAXED)
    )
    most = replace(box.amplitude, high=box.amplitude.high * _RELAXED)
    wider["amplitude"] = replace(problem, gait=replace(box, amplitude=most))
    return [name for name, one in wider.items() if chart(one, way).fastest(curvature)]
