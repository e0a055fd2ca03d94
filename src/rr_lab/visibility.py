"""How visible hidden effects are, by the laboratory's own runs, and how strong they have to be.

A run of the case is compared with the same run of the nominal robot, both without noise, after the
initial state has been fitted: place, heading and initial speed. The difference is in standard
deviations of the noise.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from rr_lab.case import Case, Plan, motion_of, stream
from rr_lab.effects import effect_named, rig_with
from rr_lab.engines import driven
from rr_lab.run import Motion, captured
from rr_opt.array import Array
from rr_opt.model.experiment import Noise
from rr_opt.model.robot import EffectUse

COARSE = 1e-3
"""s, the step: strength is not needed to better than a per cent."""

NUDGE = 0.02
"""m/s, the change of speed by which the run's sensitivity to it is measured."""

EXACT = Noise(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Reference:
    """A nominal run, (4, n) each: x, y, psi, phi, and their change for 1 m/s more at the start."""

    path: Array
    change: Array
    sigma: Array

    @classmethod
    def of(cls, case: Case, plan: Plan, step: float = COARSE) -> Reference:
        """Drive the nominal robot twice."""
        sigma = np.array([case.noise.of(channel) for channel in ("x", "y", "psi", "phi")])
        base, nudged = (
            _channels(
                driven(
                    case.engine,
                    rig_with(case.nominal),
                    plan.gait,
                    replace(plan.outing, nudge=nudge),
                    step,
                )
            )
            for nudge in (0.0, NUDGE)
        )
        return cls(base, (nudged - base) / NUDGE, sigma[:, None])

    def left(self, seen: Array) -> float:
        """RMS deviation of a run from this one, in sigma, once its initial state is fitted."""
        from scipy.optimize import least_squares  # seldom needed

        def residual(p: Array) -> Array:
            x, y, psi, phi = self.path + p[3] * self.change
            cos, sin = np.cos(p[2]), np.sin(p[2])
            moved = np.array([cos * x - sin * y + p[0], sin * x + cos * y + p[1], psi + p[2], phi])
            return ((seen - moved) / self.sigma).ravel()

        found = least_squares(residual, np.zeros(4), x_scale=(0.1, 0.1, 0.1, 0.01))
        return float(np.sqrt(np.mean(found.fun**2)))


@dataclass(frozen=True)
class Gauge:
    """Nominal runs by their plans; called with a case of the same nominal robot and the same plans,
    it returns the RMS deviation of the case from them, in sigma."""

    references: tuple[tuple[Plan, Reference], ...]

    @classmethod
    def of(cls, case: Case, count: int | None = None) -> Gauge:
        """The gauge of a case, on all its runs or on the first `count`."""
        return cls(tuple((plan, Reference.of(case, plan)) for plan in case.plans[:count]))

    def __call__(self, case: Case) -> float:
        """RMS over the runs."""
        tracked = rig_with(case.robot, case.effects).tracked
        left = [
            reference.left(_channels(motion_of(case, plan, COARSE), tracked))
            for plan, reference in self.references
        ]
        return float(np.sqrt(np.mean(np.square(left))))


def _channels(motion: Motion, tracked: tuple[float, float] = (0.0, 0.0)) -> Array:
    recording = captured(motion, "", EXACT, stream(0), tracked=tracked)
    return np.array(list(recording.values.values()))


TRIES = 6
CLOSE = 0.1
"""Relative; a strength is drawn over decades, so nothing is gained by more."""


def scaled_use(use: EffectUse, factor: float) -> EffectUse:
    """The effect `factor` times as strong; its places and directions stay."""
    effect = effect_named(use.name)
    values = {
        name: effect.parameter(name).scaled(value, factor) for name, value in use.values.items()
    }
    return EffectUse(use.name, values)


def scaled_case(case: Case, factor: float) -> Case:
    """All effects of a case `factor` times as strong."""
    return replace(case, effects=tuple(scaled_use(use, factor) for use in case.effects))


def at_visibility(
    case: Case, target: float, visibility: Callable[[Case], float]
) -> tuple[Case, float]:
    """The case with its effects scaled together until visibility(case) is `target`, and what it is.

    visibility  RMS deviation from the nominal, in sigma; it is taken to grow with the strength.
    The secant method on logarithms; where the effects reach what is believable first, or hardly
    change what is seen (a limit that is not met), the nearest that was tried is returned.
    """
    low, high = 1e-4, 1e4
    factor, best = 1.0, None
    power = 1.0
    seen: list[tuple[float, float]] = []
    for _ in range(TRIES):
        trial = scaled_case(case, factor)
        reached = max(visibility(trial), 1e-6)
        if best is None or _miss(reached, target) < _miss(best[1], target):
            best = trial, reached
        if _miss(reached, target) < CLOSE:
            break
        low, high = (factor, high) if reached < target else (low, factor)
        if seen:
            power = _slope(seen[-1], (factor, reached), power)
        seen.append((factor, reached))
        wanted = factor * min(max((target / reached) ** (1 / power), 0.05), 20.0)
        factor = wanted if low < wanted < high else (low * high) ** 0.5
    assert best is not None
    return best


def _miss(reached: float, target: float) -> float:
    return max(reached / target, target / reached) - 1


def _slope(one: tuple[float, float], two: tuple[float, float], before: float) -> float:
    """d log(reached) / d log(factor), kept between 0.3 and 3."""
    run = math.log(two[0] / one[0])
    rise = math.log(two[1] / one[1])
    return min(max(rise / run, 0.3), 3.0) if run else before
