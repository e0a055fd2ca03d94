"""One multiple-shooting solve: from a start to a candidate optimum, or a reported failure."""

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.design.candidate import StartResult
from rr_opt.design.decisions import Setting, decisions, robot_of
from rr_opt.design.landscape import Cycles, Landscape
from rr_opt.design.multiple_shooting import shooting
from rr_opt.design.shapes import path_bounds, shape_of
from rr_opt.design.transcription import GRIPS, MEANS, TURN, ZERO, Mesh, ProgramLayout
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import Interval
from rr_opt.motion.steady_cycle import grips, steady_cycle

_SENTENCES = {
    "Solve_Succeeded": "A local optimum within the solver's tolerance.",
    "Solved_To_Acceptable_Level": "The solver stopped near an optimum, short of its tolerance.",
    "Infeasible_Problem_Detected": "No gait near this start respects all limits.",
    "Maximum_Iterations_Exceeded": "The solver ran out of iterations.",
    "Maximum_CpuTime_Exceeded": "The solver ran out of time.",
    "Restoration_Failed": "The solver could not return to gaits that keep the limits.",
    "Error_In_Step_Computation": "The solver could not compute a step.",
    "Invalid_Number_Detected": "The equations of motion gave a non-finite number.",
    "Diverging_Iterates": "The iterates diverged.",
    "Search_Direction_Becomes_Too_Small": "The solver's steps became too small to continue.",
}
"""IPOPT's own return status; CasADi's unified status merges several of them."""

_AHEAD = 1e-6
# Least V . E in the wanted direction, m/s: at 0 a gait would go neither forward nor backward.

FEASIBLE = 1e-6
"""Largest violation of a satisfied constraint."""


def solve(setting: Setting, sign: int, gait: Gait, share: float, mesh: Mesh) -> StartResult:
    """Maximise the speed in direction `sign` from a gait and a share of the ballast."""
    problem = setting.problem
    by = problem.inertia_ratio.by if problem.inertia_ratio else "inertia"
    shape = shape_of(problem.gait)
    size = mesh.intervals, mesh.looks.shape[1], mesh.substeps
    grip = problem.limits.grip
    held = ("torque", *GRIPS) if math.isfinite(grip) else ("torque",)
    program = shooting(setting.dynamics.effects, by, shape, *size, loads=held)
    layout, loads = program.layout, setting.landscape.loads
    p = np.concatenate(
        [
            setting.dynamics.values(problem.robot),
            [loads.mass, loads.distance, loads.spread],
            [setting.ballast.low, setting.ballast.high],
            shape.given(mesh.checks),
            [sign],
            mesh.phases,
            np.column_stack([mesh.looks, mesh.turns]).ravel(),
        ]
    )
    lbx, ubx, lbg, ubg = _bounds(setting, layout, mesh.margin)
    x0 = _start(setting.landscape, layout, gait, share, mesh.phases)
    solver = program.solver
    result = solver(x0=np.clip(x0, lbx, ubx), p=p, lbx=lbx, ubx=ubx, lbg=lbg, ubg=ubg)
    stats = solver.stats()
    program.terms.compiled.code((1 + int(stats["iter_count"])) * mesh.intervals)
    x, g, lam_x, lam_g = (np.array(result[key]).ravel() for key in ("x", "g", "lam_x", "lam_g"))
    violation = float(np.max(np.maximum(np.maximum(lbg - g, g - ubg), 0.0)))
    status = stats["return_status"]
    values, rows, multipliers = layout.unknowns(x), layout.rows(g), layout.rows(lam_g)
    on_bounds = layout.unknowns(lam_x)
    priced = {
        load: float(sum(np.abs(multipliers[row]).sum() for row in layout.along(load)))
        for load in held
    }
    return StartResult(
        sign=sign,
        gait=shape.gait(values),
        share=float(values["ballast"]),
        speed=-float(result["f"]) * sign * math.copysign(1.0, rows["direction"]),
        feasible=bool(violation <= FEASIBLE),
        success=status == "Solve_Succeeded",
        sentence=_SENTENCES.get(status, f"The solver stopped: {status}."),
        iterations=int(stats["iter_count"]),
        prices={
            **shape.prices(problem, multipliers),
            "torque": priced["torque"],
            "grip": sum(priced.get(load, 0.0) for load in GRIPS),
            **{name: float(multipliers[name]) for name in ("direction", *TURN)},
        },
        bound_prices={
            **shape.bound_prices(on_bounds, multipliers),
            **{name: float(on_bounds[name]) for name in ("period", "ballast")},
        },
        violation=violation,
        intervals=mesh.intervals,
        mesh=mesh,
    )


def _start(
    landscape: Landscape, layout: ProgramLayout, gait: Gait, share: float, phases: Array
) -> Array:
    """The vector of unknowns on the steady cycle of a gait."""
    fine = 4 * len(phases)
    cycle = cycle_along(landscape, gait, share, fine)
    theta = np.arange(fine + 1) / fine
    v, chi = (
        np.interp(phases % 1, theta, np.append(path[:, 0], path[0, 0]))
        for path in (cycle.v, cycle.chi)
    )
    return layout.stacked(
        {
            "period": gait.period,
            "ballast": share,
            "turn": cycle.turn[0],
            **dict(zip(MEANS, cycle.mean[:, 0], strict=True)),
            "v": v,
            "chi": chi,
            **layout.shape.start(gait, phases),
        }
    )


def cycle_along(landscape: Landscape, gait: Gait, share: float, nodes: int) -> Cycles:
    """The steady cycle of one gait of any shape."""
    if isinstance(gait, SineGait):
        return landscape.cycles(
            np.array([[gait.amplitude, gait.period, gait.offset, share]]).T, nodes
        )
    t = np.arange(2 * nodes) / (2 * nodes) * gait.period
    phi, rate, acceleration = gait.angle(t), gait.rate(t), gait.acceleration(t)
    angle = phi[:, None], rate[:, None], acceleration[:, None]
    with np.errstate(all="ignore"):
        return landscape.along(angle, np.array([gait.period]), np.array([share]))


def _bounds(
    setting: Setting, layout: ProgramLayout, margin: float
) -> tuple[Array, Array, Array, Array]:
    problem = setting.problem
    share = setting.fixed_share
    if share is None and setting.ballast.fixed:
        share = 0.0
    box = decisions(problem)
    period = box.period if box.period.fixed else problem.gait.period
    limits = {"torque": problem.limits.torque, **dict.fromkeys(GRIPS, problem.limits.grip)}
    own, own_rows = layout.shape.bounds(problem)
    unknowns = {
        "period": period,
        "ballast": Interval(0.0, 1.0) if share is None else Interval(share, share),
        **own,
    }
    rows = {"direction": Interval(_AHEAD, np.inf)}
    for load in layout.loads:
        most = limits[load] * (1 - margin)
        rows |= dict.fromkeys(layout.along(load), Interval(-most, most))
    if problem.turn:
        rows |= {name: getattr(problem.turn, name) for name in TURN}
    lbx, ubx = layout.bounds(unknowns)
    # The heading is measured from platform 1's at phase 0.
    first = layout.first("chi")
    lbx[first], ubx[first] = ZERO.low, ZERO.high
    return lbx, ubx, *layout.row_bounds({**rows, **own_rows})


_SAMPLES = 1024
_NEAR_LIMIT = 0.97


@dataclass(frozen=True)
class Dense:
    """A gait evaluated on a fine grid.

    speed   m/s, signed
    used    largest utilisation of a limit
    peaks   phases in [0, 1) at which torque or grip peak near their limits
    checks  phases at which angle or rate do
    """

    speed: float
    used: float
    peaks: Array
    checks: Array


def dense(setting: Setting, gait: Gait, share: float) -> Dense:
    """Evaluate a gait on a fine grid."""
    smooth = gait.pieces == 1
    if setting.landscape.linear and smooth:
        cycle = cycle_along(setting.landscape, gait, share, _SAMPLES)
        speed, torque, v = float(cycle.speed[0]), cycle.torque[:, 0], cycle.v[:, 0]
    else:
        steps = 4 * gait.pieces * -(-_SAMPLES // gait.pieces)
        steady = steady_cycle(robot_of(setting, share), gait, steps=steps)
        speed, torque, v = steady.speed, steady.torque[:-1], steady.v[:-1]
    limits = setting.problem.limits
    shares = [torque / limits.torque]
    if math.isfinite(limits.grip):
        t = np.arange(len(v)) / len(v) * gait.period
        sides = grips(robot_of(setting, share), gait, t, v)
        shares += [side / limits.grip for side in sides]
    used, peaks, checks = 0.0, np.zeros(0), np.zeros(0)
    for load in shares:
        height, at = _peaks(np.abs(load), smooth)
        used, peaks = max(used, height), np.append(peaks, at)
    for shares in _path_shares(setting, gait):
        height, at = _peaks(np.abs(shares), True)
        used, checks = max(used, height), np.append(checks, at)
    return Dense(speed, used, peaks, checks)


def _path_shares(setting: Setting, gait: Gait) -> list[Array]:
    """Utilisation of the bounds on phi, phi - phi0 and dphi/dt between the nodes."""
    if gait.shape == "sine":
        return []
    t = np.arange(_SAMPLES) / _SAMPLES * gait.period
    phi, bounds = gait.angle(t), path_bounds(setting.problem)
    used = {"angle": phi, "swing": phi - gait.offset}
    if gait.pieces == 1:  # else it is largest at a node
        used["rate"] = gait.rate(t)
    return [share / bounds[name].high for name, share in used.items()]


def _peaks(size: Array, smooth: bool) -> tuple[float, Array]:
    """The height of the largest peak, and the phases of those near or above 1."""
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
