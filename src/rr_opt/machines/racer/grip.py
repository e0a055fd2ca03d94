"""The grip that the wheels would need not to slip: initial guesses of wheels that do.

Wheels that slide do so where the side force over the load is largest, so their friction coefficient
is below the largest ratio that was needed.
"""

from collections.abc import Mapping, Sequence
from functools import lru_cache

import casadi as ca
import numpy as np

from rr_opt.machines.racer.model import RacerModel
from rr_opt.machines.racer.parameters import values_of
from rr_opt.machines.racer.simulation import speeds_of
from rr_opt.mechanics.code_generation import ArrayFunction, over_arrays
from rr_opt.mechanics.kane import equations
from rr_opt.mechanics.kinematics import ROBOT_PARAMETERS, wheel_loads
from rr_opt.motion.dynamics import assembled
from rr_opt.sysid.estimation import Fit

_FRACTIONS = (0.95, 0.6, 0.2, 0.03)
"""Fractions of the largest grip needed that are tried: from almost enough to hardly any."""


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
    """Initial values, by the form of `lateral_slip`."""
    forms = racer.catalogue["lateral_slip"].forms
    (creep,) = forms[0].quantities
    most = grip_needed(racer, fit)
    creeping = [(0, {creep.name: size * creep.scale}) for size in (0.3, 3.0)]
    mu, gradual = "lateral_slip.mu", 0.3 * creep.scale
    sliding = [(1, {creep.name: gradual, mu: part * most}) for part in _FRACTIONS]
    # Wheels with hardly any grip also creep easily, and from there a fit sees more of the sliding.
    ice = (1, {creep.name: 300 * creep.scale, mu: _FRACTIONS[-1] * most})
    return [*creeping, *sliding, ice]
