"""The grip that the wheels would need not to slip: initial guesses of wheels that do.

Wheels that slide do so where the side force over the load is largest, so their friction coefficient
is below the largest ratio that was needed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

import casadi as ca
import numpy as np

from rr_opt.machines.racer.model import RacerModel
from rr_opt.machines.racer.parameters import values_of
from rr_opt.machines.racer.simulation import Change, speeds_of
from rr_opt.mechanics.code_generation import ArrayFunction, over_arrays
from rr_opt.mechanics.kane import equations
from rr_opt.mechanics.kinematics import ROBOT_PARAMETERS, wheel_loads
from rr_opt.motion.dynamics import assembled
from rr_opt.sysid.candidates import trial_problem
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.score_test import secants
from rr_opt.sysid.settings import SETTINGS

_SLIP = "lateral_slip"


@lru_cache
def _needed() -> ArrayFunction:
    """(v, phi, dphi, vdot, ddphi, p) -> side force over load of both axles (2,)."""
    assembly = assembled((), for_prediction=True)
    robot = assembly.mechanism
    kane = equations(robot)
    loads = wheel_loads(robot.parameters)
    held = ca.vertcat(robot.speeds[1:3], kane.udot[1:3])
    sides = ca.substitute(kane.needed[1:3], held, ca.SX.zeros(4))
    grip = ca.vertcat(sides[0] / (2 * loads[1]), sides[1] / (2 * loads[2]))
    inputs = [robot.speeds[0], robot.phi, robot.speeds[3], kane.udot[0], kane.udot[3], assembly.p]
    return over_arrays(ca.Function("grip_needed", inputs, [grip]))


def grip_needed(racer: RacerModel, fit: Fit) -> float:
    """The largest side force over load of an axle that does not slip, over all recordings."""
    simulator = racer.simulator
    speeds, given = speeds_of(simulator.every(fit.effects)), simulator.given(fit.values)
    plain = values_of(given, ROBOT_PARAMETERS)
    worst = 0.0
    requests = fit.problem.requests(fit.values, fit.states)
    paths = simulator.paths(requests, fit.effects)
    for request, (path, made, p, _) in zip(requests, paths, strict=True):
        t = racer.runs[request.segment.run].t[request.segment.span]
        if t.size < 3:
            continue
        v, *_ = speeds(*made.states[:, :: path.each], *path.at, *p)
        phi, dphi = path.at[:2]
        rates = np.gradient(v, t), np.gradient(dphi, t)
        grip = _needed()(v, phi, dphi, *rates, *plain)
        # A single sample, as where the servo's rate jumps, is not what the wheels feel.
        worst = max(worst, float(np.nanquantile(np.abs(np.array(grip)), 0.99)))
    return worst


def slips(racer: RacerModel, fit: Fit) -> Sequence[tuple[int, Mapping[str, float]]]:
    """Initial values of wheels that slide, by the form of `lateral_slip`: those that would explain
    something, the best first."""
    creep, mu, ratio = (q.name for q in racer.catalogue[_SLIP].forms[-1].quantities)
    if mu in fit.problem.names:
        # Costly, and at the wrong grip a share of it may gain nothing.
        return [(2, {ratio: 1.0})] if fit.excess > SETTINGS.none else []
    most, usual = grip_needed(racer, fit), racer.catalogue[_SLIP].forms[0].quantities[0].scale
    creeps = [size * usual for size in SETTINGS.creeps]
    if _SLIP in fit.effects:
        creeps = [fit.values[creep]]
    guesses = [(1, {creep: c, mu: part * most}) for c in creeps for part in SETTINGS.grips]
    # Less creep than that is seen by the score test.
    guesses += [(0, {creep: c}) for c in creeps[1:]]
    gains = _gains(racer, fit, [guess for _, guess in guesses])
    ranked = sorted(zip(gains, range(len(guesses)), strict=True), reverse=True)
    return [guesses[k] for gain, k in ranked if gain > 0][: SETTINGS.slips]


def _gains(racer: RacerModel, fit: Fit, guesses: Sequence[Mapping[str, float]]) -> list[float]:
    """What a share of the change that each of the values makes would gain, as a score."""
    simulator, problem = racer.simulator, trial_problem(fit.problem, fit)
    slipping = tuple(sorted({*fit.effects, _SLIP}))
    requests = problem.requests(fit.values, fit.states)
    here = simulator.paths(requests, fit.effects)
    seen, ends = [], []
    for guess in guesses:
        values = {**fit.values, **guess}
        moved = [replace(one, values=values) for one in requests]
        begun = [replace(one, state=simulator.converted(one, slipping)) for one in moved]
        made = simulator.paths(begun, slipping)
        for one, (_, before, _, _), (_, after, _, _) in zip(moved, here, made, strict=True):
            segment = one.segment._replace(first=one.segment.last)
            last = replace(one, segment=segment, state=after.states[:, -1])
            end = simulator.converted(last, fit.effects) - before.states[:, -1]
            known = np.isfinite(end).all() and np.isfinite(after.seen).all()
            seen.append(after.seen - before.seen if known else np.zeros_like(before.seen))
            ends.append(end if known else np.zeros_like(end))
    count = len(requests)
    changes = [
        Change(np.stack(seen[k::count], axis=-1), np.stack(ends[k::count], axis=-1))
        for k in range(count)
    ]
    parts = simulator.linearise(requests, fit.effects, problem.names, changes)
    every = dict(zip(problem.segments, parts, strict=True))
    return secants(fit, problem, every)
