"""Everything computed from the paper: its tables and figures, and the audit of its statements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.model.robot import Robot
from rr_opt.results.result import Result
from rr_paper.best_amplitude import BestAmplitude, audit_best_amplitude
from rr_paper.consistency import Consistency, audit_hypotheses
from rr_paper.prototype import ABOUT_P, Sensitivity, sensitivities
from rr_paper.publication import TABLE_3
from rr_paper.signs import SignAudit, audit_signs
from rr_paper.statements import (
    PeriodLaw,
    ServoDemand,
    SingularPosture,
    Turning,
    audit_period,
    audit_turning,
    servo_demands,
    singular_posture,
)
from rr_paper.tables import (
    SpeedSurface,
    Start,
    Tables,
    figure4,
    figure5,
    recompute,
    start_from_rest,
)

_TYPICAL = TABLE_3[1]
"""The row that is driven where the paper does not say which run it shows."""
_SECONDS = 10.0
_SETTLED = 20.0
"""A run from rest is steady by then, s."""


@dataclass(frozen=True, repr=False)
class Reproduction(Result):
    """sha256: of the shipped problem; robot: its robot; mujoco: speed of the gait of Fig. 3 in
    MuJoCo, m/s, or None."""

    REPORT = "rr_paper.report.reproduction"

    sha256: str
    robot: Robot
    tables: Tables
    start: Start
    ratio_surface: SpeedSurface
    period_surface: SpeedSurface
    turning: Turning
    signs: SignAudit
    sensitivities: tuple[Sensitivity, ...]
    consistency: Consistency
    demands: tuple[ServoDemand, ...]
    posture: SingularPosture
    period: PeriodLaw
    best: BestAmplitude
    mujoco: float | None

    @property
    def warnings(self) -> tuple[str, ...]:
        """Whether a check is missing."""
        if self.mujoco is not None:
            return ()
        return (
            "MuJoCo is not installed, so it could not be used as a further check of the signs of "
            "equation (3). Install it with `pip install 'rr-opt[lab]'`.",
        )


def reproduce(problem: Problem, progress: Callable[[str], None]) -> Reproduction:
    """Compute all of it for the robot of a problem, in a minute. Raises NotConvergedError."""
    robot = problem.robot
    loaded = ABOUT_P.build(robot, _TYPICAL.ratio)
    gait = SineGait(_TYPICAL.amplitude or 0.0, _TYPICAL.period)
    progress("Tables 2 and 3")
    tables = recompute(robot)
    progress("Fig. 3")
    start = start_from_rest(loaded, _TYPICAL, gait)
    progress("Figs. 4 and 5")
    surfaces = figure4(robot), figure5(robot)
    progress("Fig. 6 and its claim")
    turning = audit_turning(problem)
    progress("signs of equation (3)")
    signs = audit_signs(loaded, gait, _SECONDS)
    consistency = audit_hypotheses(progress)
    progress("speed over the period")
    period = audit_period(robot)
    fits = [*consistency.of("ratio", "mean"), *consistency.of("equation", "mean")]
    best = audit_best_amplitude(robot, fits, progress)
    progress("MuJoCo")
    return Reproduction(
        problem.sha256, robot, tables, start, *surfaces, turning, signs,
        sensitivities(robot, _TYPICAL), consistency, servo_demands(tables.amplitude),
        singular_posture(robot), period, best, mujoco_speed(loaded, gait),
    )  # fmt: skip


def mujoco_speed(robot: Robot, gait: SineGait) -> float | None:
    """The mean speed of a gait in the virtual laboratory, m/s; None without MuJoCo."""
    if find_spec("mujoco") is None:
        return None
    from rr_lab.case import record

    seen = record(robot, gait, _SETTLED, "rest")
    x, y, psi = (seen.values[name] for name in ("x", "y", "psi"))
    return last_period_speed(seen.t, x, y, psi, gait.period)


def last_period_speed(t: Array, x: Array, y: Array, psi: Array, period: float) -> float:
    """Mean speed over the last period of a straight run, m/s, signed along platform 1.

    t (s), x, y (m), psi (rad): (n,), at equal steps of which a period holds a whole number.
    """
    steps = round(period / float(t[1] - t[0]))
    chord = np.array([x[-1] - x[-1 - steps], y[-1] - y[-1 - steps]])
    heading = psi[-steps:]
    ahead = chord @ np.array([np.cos(heading).mean(), np.sin(heading).mean()])
    return float(np.copysign(np.hypot(*chord), ahead)) / period
