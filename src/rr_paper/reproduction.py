"""Everything that is computed from the paper: its tables and figures again, and its audit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.model.robot import Robot
from rr_paper.best_amplitude import Asked, BestAmplitude, Posture, asked, audit_best, posture
from rr_paper.consistency import ABOUT_P, Consistency, audit_readings
from rr_paper.left_out import LeftOut, audit_left_out
from rr_paper.period_law import PeriodLaw, audit_period
from rr_paper.printed import TABLE_3
from rr_paper.signs import SignAudit, audit_signs
from rr_paper.surfaces import SpeedSurface, figure4, figure5
from rr_paper.tables import Start, Tables, regenerate, start_from_rest
from rr_paper.turning import Turning, audit_turning

_TYPICAL = TABLE_3[1]
"""The row that is driven where the paper does not say which run it shows."""
_SECONDS = 10.0


@dataclass(frozen=True)
class Reproduction:
    """robot: the shipped prototype, with J20/J10 = 0.3 about P as `loaded`."""

    robot: Robot
    loaded: Robot
    tables: Tables
    start: Start
    ratio_surface: SpeedSurface
    period_surface: SpeedSurface
    turning: Turning
    signs: SignAudit
    left_out: tuple[LeftOut, ...]
    consistency: Consistency
    asked: tuple[Asked, ...]
    posture: Posture
    period: PeriodLaw
    best: BestAmplitude


def reproduce(problem: Problem, progress: Callable[[str], None]) -> Reproduction:
    """Compute all of it for the robot of a problem; under a minute. Raises NotConvergedError."""
    robot = problem.robot
    loaded = ABOUT_P.build(robot, _TYPICAL.ratio)
    gait = SineGait(_TYPICAL.amplitude or 0.0, _TYPICAL.period)
    progress("Tables 2 and 3")
    tables = regenerate(robot)
    progress("Fig. 3")
    start = start_from_rest(loaded, _TYPICAL)
    progress("Figs. 4 and 5")
    surfaces = figure4(robot), figure5(robot)
    progress("Fig. 6 and its claim")
    turning = audit_turning(problem)
    progress("signs of equation (3)")
    signs = audit_signs(loaded, gait, _SECONDS)
    consistency = audit_readings(progress)
    progress("speed over the period")
    period = audit_period(robot)
    fits = [(one.name, one.reading, one.signs, one.fit)
            for question in ("ratio", "equation")
            for one in consistency.of(question, "mean")]  # fmt: skip
    best = audit_best(robot, fits, progress)
    return Reproduction(
        robot, loaded, tables, start, *surfaces, turning, signs,
        audit_left_out(robot, _TYPICAL), consistency, asked(tables.amplitude), posture(robot),
        period, best,
    )  # fmt: skip
