"""The size of hidden effects, from the laboratory's own runs, and the strength for a given size.

A run of the case is compared with the same run of the nominal robot, both without noise, after
fitting the initial state: place, heading and initial speed. The effect size is the RMS
difference in standard deviations of the noise.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import lsq_linear

from rr_lab.case import EXACT, Case, Plan, driven, fine_enough, motion_of, stream
from rr_lab.effects import effect_named
from rr_lab.run import Motion, captured
from rr_opt.array import Array
from rr_opt.model.parameters import parameters_of, with_parameters
from rr_opt.model.robot import EffectUse, Robot

COARSE = 1e-3
"""Step, s: strength need not be accurate beyond a per cent."""

SPEED_NUDGE = 0.02
"""m/s, the change of speed for the finite-difference sensitivity of a run."""

CHANNELS = ("x", "y", "psi", "phi")


def exact_path(case: Case, plan: Plan, step: float = COARSE) -> Array:
    """The noise-free observations of a run of a case, (4, n): CHANNELS."""
    return _seen(motion_of(case, plan, step), case.rig.tracked)


def _seen(motion: Motion, tracked: Sequence[float] = (0.0, 0.0)) -> Array:
    recording = captured(motion, "", EXACT, stream(0), tracked=tracked)
    return np.array(list(recording.values.values()))


@dataclass(frozen=True)
class NominalRun:
    """A run to compare others with, (4, n) each: its path, and its sensitivity to the initial
    speed, per m/s."""

    path: Array
    change: Array
    sigma: Array

    @classmethod
    def of(cls, case: Case, plan: Plan, step: float = COARSE) -> NominalRun:
        """Drive the case's robot, with its effects, twice."""
        sigma = np.array([case.noise.of(channel) for channel in CHANNELS])
        rig, conditions = case.rig, plan.conditions
        base, nudged = (
            _seen(driven(case.engine, rig, plan.gait, start, step), rig.tracked)
            for start in (conditions, replace(conditions, nudge=SPEED_NUDGE))
        )
        return cls(base, (nudged - base) / SPEED_NUDGE, sigma[:, None])

    def deviation(self, seen: Array) -> float:
        """RMS deviation of a run from this one, in sigma, after fitting its initial state."""
        from scipy.optimize import least_squares  # rarely needed

        def residual(p: Array) -> Array:
            x, y, psi, phi = self.path + p[3] * self.change
            cos, sin = np.cos(p[2]), np.sin(p[2])
            moved = np.array([cos * x - sin * y + p[0], sin * x + cos * y + p[1], psi + p[2], phi])
            return ((seen - moved) / self.sigma).ravel()

        found = least_squares(residual, np.zeros(4), x_scale=(0.1, 0.1, 0.1, 0.01))
        return float(np.sqrt(np.mean(found.fun**2)))


@dataclass(frozen=True)
class EffectSize:
    """Nominal runs by their plans; called with a case of the same nominal robot and the same plans,
    it returns the RMS deviation of the case from them, in sigma."""

    runs: tuple[tuple[Plan, NominalRun], ...]

    @classmethod
    def of(cls, case: Case, count: int | None = None) -> EffectSize:
        """On all runs of a case, or on the first `count`."""
        nominal = replace(case, robot=case.nominal, effects=())
        return cls(tuple((plan, NominalRun.of(nominal, plan)) for plan in case.plans[:count]))

    def __call__(self, case: Case) -> float:
        """RMS over the runs."""
        left = [run.deviation(exact_path(case, plan)) for plan, run in self.runs]
        return float(np.sqrt(np.mean(np.square(left))))


TRIES = 6
CLOSE = 0.1
"""Relative tolerance; a strength is drawn over decades, so more accuracy gains nothing."""


def scaled_use(use: EffectUse, factor: float) -> EffectUse:
    """The effect `factor` times as strong; its places and directions are unchanged."""
    effect = effect_named(use.name)
    values = {
        name: effect.accepted[name].scaled(value, factor) for name, value in use.values.items()
    }
    return EffectUse(use.name, values)


def scaled_to(case: Case, target: float, size: Callable[[Case], float]) -> tuple[Case, float]:
    """The case with its effects scaled together until size(case) is `target`, and the size reached.

    size  RMS deviation from the nominal, in sigma; assumed to increase with the strength.
    Secant method on logarithms. If the effects become implausibly large first, or hardly change the
    observations (an inactive limit), the closest one tried is returned.
    """
    low, high, factor, power = 1e-4, 1e4, 1.0, 1.0
    tried: list[tuple[Case, float, float]] = []
    for _ in range(TRIES):
        trial = replace(case, effects=tuple(scaled_use(use, factor) for use in case.effects))
        reached = max(size(trial), 1e-6)
        if tried:
            power = _slope(tried[-1][1:], (factor, reached), power)
        tried.append((trial, factor, reached))
        if _miss(reached, target) < CLOSE:
            break
        low, high = (factor, high) if reached < target else (low, factor)
        wanted = factor * min(max((target / reached) ** (1 / power), 0.05), 20.0)
        factor = wanted if low < wanted < high else (low * high) ** 0.5
    best, _, reached = min(tried, key=lambda one: _miss(one[2], target))
    return best, reached


def _miss(reached: float, target: float) -> float:
    return max(reached / target, target / reached) - 1


def _slope(one: tuple[float, float], two: tuple[float, float], before: float) -> float:
    """d log(reached) / d log(factor), clipped to 0.3 .. 3."""
    run = math.log(two[0] / one[0])
    rise = math.log(two[1] / one[1])
    return min(max(rise / run, 0.3), 3.0) if run else before


NUDGE = 0.5
"""Step of a parameter for its finite difference, in sigma."""

FARTHEST = 3.0
"""Largest change of a parameter, in sigma."""

STEP, DIRECTIONS = 5e-3, 1e-2
"""Integration steps, s: in the compared runs, and for derivatives."""

FINEST = 1e-3
"""Shortest step of nominal runs, s."""

STEPS = 3
SETTLED = 0.02
"""Sigma; convergence threshold of the step."""


@dataclass(frozen=True)
class Detectability:
    """Nominal runs by their plans, and how the parameters change them.

    slopes  for each run (4, n, parameters): x, y, psi, phi in sigma, per sigma of the parameter.
            For an unknown friction, sigma is the log of its factor
    """

    case: Case
    runs: dict[Plan, NominalRun]
    slopes: tuple[Array, ...]

    @classmethod
    def of(cls, case: Case, beside: Sequence[EffectUse] = ()) -> Detectability:
        """Drive the nominal robot, and once for each parameter, on the runs that are fitted; with
        the effects beside which another one has to show."""
        plain = replace(case, robot=case.nominal, effects=tuple(beside))
        fitted = [plan for plan in case.plans if plan.use == "fit"]
        runs = {plan: NominalRun.of(plain, plan, DIRECTIONS) for plan in fitted}
        moved = [
            replace(plain, robot=moved_robot(case, NUDGE * unit))
            for unit in np.eye(len(case.uncertainty))
        ]
        slopes = tuple(
            np.stack([exact_path(one, plan, DIRECTIONS) - run.path for one in moved], axis=-1)
            / (NUDGE * run.sigma[..., None])
            for plan, run in runs.items()
        )
        return cls(plain, _driven(plain, runs, STEP), slopes)

    def remains(self, case: Case) -> float:
        """RMS deviation, sigma, of the case's runs from the nominal ones after the re-fit."""
        fine = fine_enough(case.engine, case.rig, STEP)
        seen = [exact_path(case, plan, fine) for plan in self.runs]
        step = max(fine, FINEST)
        at, least = np.zeros(len(case.uncertainty)), math.inf
        runs = self.runs if step == STEP else _driven(self.case, self.runs, step)
        for _ in range(STEPS + 1):
            pairs = list(zip(runs.values(), seen, strict=True))
            left = [run.deviation(path) ** 2 for run, path in pairs]
            least = min(least, float(np.sqrt(np.mean(left))))
            before, at = at, self._stepped(at, pairs)
            if np.abs(at - before).max() < SETTLED:
                break
            there = replace(self.case, robot=moved_robot(self.case, at))
            runs = _driven(there, runs, step)
        return least

    def _stepped(self, at: Array, pairs: list[tuple[NominalRun, Array]]) -> Array:
        """The parameters, in sigma, after a Gauss-Newton step with their uncertainties as prior,
        within their box."""
        rows, sides = [np.eye(len(at))], [-at]
        for (run, seen), slopes in zip(pairs, self.slopes, strict=True):
            # The effect of the initial state is projected out of both sides.
            start = np.linalg.qr(_starts(run))[0]
            off = ((seen - run.path) / run.sigma).ravel()
            turned = slopes.reshape(off.size, -1)
            rows.append(turned - start @ (start.T @ turned))
            sides.append(off - start @ (start.T @ off))
        known = self.case.uncertainty.values()
        most = np.array([1.0 if one.factor else FARTHEST for one in known])
        # R of the QR factorisation replaces the thousands of rows of the least squares.
        table = np.column_stack([np.concatenate(rows), np.concatenate(sides)])
        reduced: Array = np.linalg.qr(table).R
        free = reduced[:-1]
        return at + lsq_linear(free[:, :-1], free[:, -1], (-most - at, most - at)).x


def moved_robot(case: Case, sigmas: Array) -> Robot:
    """The nominal robot with its parameters moved by `sigmas`, in the order of the case's
    uncertainties."""
    values = parameters_of(case.nominal)
    for (name, known), by in zip(case.uncertainty.items(), sigmas, strict=True):
        value = values[name]
        values[name] = float(value * known.factor**by if known.factor else value + known.sigma * by)
    return with_parameters(case.nominal, values)


def _starts(run: NominalRun) -> Array:
    """The sensitivity of a run to place, heading and initial speed, in sigma, (4 n, 4)."""
    x, y = run.path[:2]
    zero, one = np.zeros_like(x), np.ones_like(x)
    columns = [(one, zero, zero, zero), (zero, one, zero, zero), (-y, x, one, zero)]
    made = [*(np.array(column) for column in columns), run.change]
    return np.stack([(each / run.sigma).ravel() for each in made], axis=-1)


def _driven(case: Case, runs: dict[Plan, NominalRun], step: float) -> dict[Plan, NominalRun]:
    """The nominal runs with the paths of a case, integrated with a step, s."""
    return {plan: replace(run, path=exact_path(case, plan, step)) for plan, run in runs.items()}
