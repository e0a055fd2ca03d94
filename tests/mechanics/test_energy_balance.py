"""The servo's work is the change of kinetic energy plus the dissipation, with any effects."""

from functools import lru_cache
from itertools import combinations

import casadi as ca
import pytest
from hypothesis import given

from rr_opt.motion.dynamics import derive, dynamics_of, steady_effects
from tests.mechanics.cases import REPEATABLE, cases, energy, motion

NAMES = sorted(steady_effects())
CHOICES = sorted({c for size in (0, 1, 2, len(NAMES)) for c in combinations(NAMES, size)})


@lru_cache
def kinetic_slopes(effects: tuple[str, ...]) -> ca.Function:
    """The derivatives of the kinetic energy by v, phi and dphi."""
    model = derive(effects)
    v, phi, dphi, p = (model.energy.sx_in(i) for i in range(4))
    kinetic = model.energy(v, phi, dphi, p)[0]
    slopes = [ca.gradient(kinetic, speed) for speed in (v, phi, dphi)]
    return ca.Function("slopes", [v, phi, dphi, p], slopes)


@pytest.mark.parametrize("effects", CHOICES, ids=lambda names: "+".join(names) or "paper")
def test_work_is_accounted_for(effects):
    @REPEATABLE
    @given(cases(effects))
    def balance(case):
        robot, state = case
        out = motion(robot, state)
        _, dissipation = energy(robot, state)
        slopes = kinetic_slopes(effects)(*state[:3], dynamics_of(robot).values(robot))
        rates = (out.vdot, state.dphi, state.ddphi)
        gains = [float(slope) * rate for slope, rate in zip(slopes, rates, strict=True)]
        work = out.torque * state.dphi
        size = sum(abs(gain) for gain in gains) + abs(dissipation) + abs(work) + 1e-6
        assert abs(work - sum(gains) - dissipation) < 1e-10 * size
        assert dissipation >= 0

    balance()
