"""How much of an effect remains after the nominal robot's parameters are re-fitted.

An effect that other parameter values can imitate cannot be named by anybody. How much of it remains
is computed from the laboratory's own runs, so that the diagnosis does not judge itself. The fitted
runs, without noise, are compared with those of the nominal robot, whose parameters may move by up
to three sigma (an unknown friction within its factor) and whose initial states are free.

The fit is Gauss-Newton with the derivatives of the nominal robot; the best of a few steps is taken.
Where the robot is too nonlinear for that, what remains is overestimated, never underestimated.

All runs that are compared use the same coarse step, five times that of the effect size, so that its
error cancels. Where an engine needs a finer step for an effect, the nominal runs are repeated with
that step, or with 1 ms, whose own error is 0.03 sigma at most. The derivatives, which only give the
direction, come from runs with twice the coarse step. Of 28 random effects 18 agree within 2 % with
steps of 1 ms, and 25 within 9 %. In the other three Gauss-Newton does not settle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import lsq_linear

from rr_lab.case import Case, Plan
from rr_lab.effect_size import NominalRun, exact_path
from rr_lab.engines import fine_enough
from rr_opt.array import Array
from rr_opt.model.parameters import parameters_of, with_parameters
from rr_opt.model.robot import Robot

NUDGE = 0.5
"""Of one sigma, by which a parameter is moved for its derivative."""

FARTHEST = 3.0
"""Sigma, by which a parameter may be moved."""

STEP, DIRECTIONS = 5e-3, 1e-2
"""s, of the integration: in the runs that are compared, and for derivatives."""

FINEST = 1e-3
"""s, the shortest step of nominal runs."""

STEPS = 3
SETTLED = 0.02
"""Sigma; a smaller step changes nothing."""


@dataclass(frozen=True)
class Detectability:
    """Nominal runs by their plans, and how the parameters change them.

    slopes  for each run (4, n, parameters): x, y, psi, phi in sigma, per sigma of the parameter.
            A friction of which nothing is known has its factor for a sigma, in its logarithm
    """

    case: Case
    runs: dict[Plan, NominalRun]
    slopes: tuple[Array, ...]

    @classmethod
    def of(cls, case: Case) -> Detectability:
        """Drive the nominal robot, and once for each parameter, on the runs that are fitted."""
        plain = replace(case, robot=case.nominal, effects=())
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
        """The parameters, in sigma, after a Gauss-Newton step with their uncertainties as prior, in
        their box."""
        rows, sides = [np.eye(len(at))], [-at]
        for (run, seen), slopes in zip(pairs, self.slopes, strict=True):
            # What the initial state can explain is taken out of both sides.
            start = np.linalg.qr(_starts(run))[0]
            off = ((seen - run.path) / run.sigma).ravel()
            turned = slopes.reshape(off.size, -1)
            rows.append(turned - start @ (start.T @ turned))
            sides.append(off - start @ (start.T @ off))
        known = self.case.uncertainty.values()
        most = np.array([1.0 if one.factor else FARTHEST for one in known])
        # R of the QR factors has all that the least squares need of the thousands of rows.
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
    """What place, heading and first speed of a run change in it, in sigma, (4 n, 4)."""
    x, y = run.path[:2]
    zero, one = np.zeros_like(x), np.ones_like(x)
    columns = [(one, zero, zero, zero), (zero, one, zero, zero), (-y, x, one, zero)]
    made = [*(np.array(column) for column in columns), run.change]
    return np.stack([(each / run.sigma).ravel() for each in made], axis=-1)


def _driven(case: Case, runs: dict[Plan, NominalRun], step: float) -> dict[Plan, NominalRun]:
    """The nominal runs with the paths of a case, driven with a step, s."""
    return {plan: replace(run, path=exact_path(case, plan, step)) for plan, run in runs.items()}
