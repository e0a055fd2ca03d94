"""One multiple-shooting solve: a start in, a candidate optimum or an honest failure out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.decisions import decisions
from rr_opt.design.interval import DECISIONS, LIMITS, TURN
from rr_opt.design.landscape import Landscape
from rr_opt.design.multiple_shooting import shooting
from rr_opt.design.setting import Setting
from rr_opt.problem import Interval
from rr_opt.robot.gait import SineGait

Array = NDArray[np.float64]

_SENTENCES = {
    "Solve_Succeeded": "A local optimum within the solver's tolerance.",
    "Solved_To_Acceptable_Level": "The solver stopped near an optimum, short of its tolerance.",
    "Infeasible_Problem_Detected": "No gait near this start keeps all limits.",
    "Maximum_Iterations_Exceeded": "The solver ran out of iterations.",
    "Maximum_CpuTime_Exceeded": "The solver ran out of time.",
    "Restoration_Failed": "The solver could not get back to gaits that keep the limits.",
    "Error_In_Step_Computation": "The solver could not compute a step.",
    "Invalid_Number_Detected": "The equations of motion gave a number that is not finite.",
    "Diverging_Iterates": "The iterates ran away.",
    "Search_Direction_Becomes_Too_Small": "The solver's steps became too small to go on.",
}
"""IPOPT's own word for how it ended; CasADi's unified status folds several of them together."""

_AHEAD = 1e-6
# Least V . E in the wanted direction, m/s: at 0 a gait would go neither forward nor backward.

FEASIBLE = 1e-6
"""Largest violation of a row that still counts as kept."""


@dataclass(frozen=True)
class Candidate:
    """What one start led to.

    sign         +1 forward, -1 backward
    gait, share  the gait, and the ballast's share of its range
    speed        signed, m/s
    feasible     every row holds within FEASIBLE
    success      the solver says it is an optimum
    sentence     the same in words
    prices       speed gained per unit of each limit, m/s per unit: rate, angle, torque,
                 singularity, direction, and curvature, yaw_rate, heading of the turn
    bound_prices speed gained per unit by which a decision's active bound moves up
    x, lam_x, lam_g, phases   where to go on from
    """

    sign: int
    gait: SineGait
    share: float
    speed: float
    feasible: bool
    success: bool
    sentence: str
    iterations: int
    prices: Mapping[str, float]
    bound_prices: Mapping[str, float]
    violation: float
    phases: Array = field(repr=False)
    v: Array = field(repr=False)
    chi: Array = field(repr=False)

    @property
    def rank(self) -> tuple[bool, bool, float]:
        """Sort key: infeasible last, then unsuccessful, then slow."""
        return (not self.feasible, not self.success, -abs(self.speed))


def solve(setting: Setting, sign: int, gait: SineGait, share: float, phases: Array) -> Candidate:
    """Maximise the speed in direction `sign` from a gait and a share of the ballast.

    phases (N,): nodes in [0, 1), increasing; the first is 0.
    """
    problem, n = setting.problem, len(phases)
    by = problem.inertia_ratio.by if problem.inertia_ratio else "inertia"
    program = shooting(setting.dynamics.effects, by, n)
    loads = setting.landscape.loads
    p = np.concatenate(
        [
            setting.dynamics.values(problem.robot),
            [loads.mass, loads.distance, loads.spread],
            [setting.ballast.low, setting.ballast.high],
            [sign],
            phases,
        ]
    )
    lbx, ubx, lbg, ubg = _bounds(setting, n)
    x0 = _start(setting.landscape, gait, share, phases)
    result = program.solver(x0=np.clip(x0, lbx, ubx), p=p, lbx=lbx, ubx=ubx, lbg=lbg, ubg=ubg)
    stats = program.solver.stats()
    x = np.array(result["x"]).ravel()
    g = np.array(result["g"]).ravel()
    lam_g, lam_x = (np.array(result[key]).ravel() for key in ("lam_g", "lam_x"))
    violation = float(np.max(np.maximum(np.maximum(lbg - g, g - ubg), 0.0)))
    status = stats["return_status"]
    amplitude, period, offset, share = (float(value) for value in x[:4])
    forward = math.copysign(1.0, g[2 * n + 4 + LIMITS.index("direction")])
    first_v = len(DECISIONS) + 4
    return Candidate(
        sign=sign,
        gait=SineGait(amplitude, period, offset),
        share=share,
        speed=-float(result["f"]) * sign * forward,
        feasible=bool(violation <= FEASIBLE),
        success=status == "Solve_Succeeded",
        sentence=_SENTENCES.get(status, f"The solver stopped: {status}."),
        iterations=int(stats["iter_count"]),
        prices=_prices(lam_g, n),
        bound_prices=dict(zip(DECISIONS[:4], map(float, lam_x[:4]), strict=True)),
        violation=violation,
        phases=phases,
        v=x[first_v : first_v + n],
        chi=x[first_v + n :],
    )


def _start(landscape: Landscape, gait: SineGait, share: float, phases: Array) -> Array:
    """The vector of unknowns on the steady cycle of a gait."""
    fine = 4 * len(phases)
    point = [gait.amplitude, gait.period, gait.offset, share]
    cycle = landscape.cycles(np.array(point)[:, None], fine)
    theta = np.arange(fine + 1) / fine
    v, chi = (
        np.interp(phases, theta, np.append(path[:, 0], path[0, 0])) for path in (cycle.v, cycle.chi)
    )
    return np.concatenate([[*point, cycle.turn[0]], cycle.mean[:, 0], v, chi])


def _bounds(setting: Setting, n: int) -> tuple[Array, Array, Array, Array]:
    problem, infinite = setting.problem, np.full(2 * n, np.inf)
    gait, limits = problem.gait, problem.limits
    share = setting.fixed_share
    if share is None and setting.ballast.fixed:
        share = 0.0
    shares = Interval(0.0, 1.0) if share is None else Interval(share, share)
    # Where limits and bounds leave one value there is no inside for the solver to move in: the
    # decision is fixed, and rows that then depend on nothing free are dropped.
    box = decisions(problem)
    amplitude = Interval(*[gait.amplitude.low] * 2) if box.amplitude_pinned else gait.amplitude
    period = box.period if box.period.fixed else gait.period
    offset = box.offset if box.offset.fixed else gait.offset
    boxes = (amplitude, period, offset, shares)
    free = [np.inf] * 5
    lbx = np.concatenate([[box.low for box in boxes], np.negative(free), -infinite])
    ubx = np.concatenate([[box.high for box in boxes], free, infinite])
    # The heading is counted from platform 1's at phase 0.
    first_chi = len(DECISIONS) + 4 + n
    lbx[first_chi] = ubx[first_chi] = 0.0
    tight = np.zeros(2 * n + 4)
    low = {
        "singularity+": limits.singularity,
        "singularity-": limits.singularity,
        "direction": _AHEAD,
    }
    high = {"rate": limits.rate, "angle+": limits.angle, "angle-": limits.angle}
    if amplitude.fixed and offset.fixed:
        low = {"direction": _AHEAD}
        high = {"rate": limits.rate}
    if amplitude.fixed and period.fixed:
        high.pop("rate")
    for name in TURN if problem.turn else ():
        asked = getattr(problem.turn, name)
        low[name], high[name] = asked.low, asked.high
    lbg = [tight, [low.get(name, -np.inf) for name in LIMITS], np.full(n, -limits.torque)]
    ubg = [tight, [high.get(name, np.inf) for name in LIMITS], np.full(n, limits.torque)]
    return lbx, ubx, np.concatenate(lbg), np.concatenate(ubg)


def _prices(lam_g: Array, n: int) -> dict[str, float]:
    rows = dict(zip(LIMITS, lam_g[2 * n + 4 : 2 * n + 4 + len(LIMITS)], strict=True))
    return {
        "rate": float(rows["rate"]),
        "angle": float(rows["angle+"] + rows["angle-"]),
        "torque": float(np.abs(lam_g[2 * n + 4 + len(LIMITS) :]).sum()),
        "singularity": float(rows["singularity+"] + rows["singularity-"]),
        "direction": float(rows["direction"]),
        **{name: float(rows[name]) for name in TURN},
    }
