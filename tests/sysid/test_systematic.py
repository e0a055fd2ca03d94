"""Dry friction that explains the recordings is believed, unless what it leaves is no noise."""

from dataclasses import replace

import casadi as ca
import pytest

from rr_opt.machines.racer.residual import systematic
from rr_opt.sysid.candidate import FLOOR, Chosen
from tests.sysid.made_up import base_of, explained, with_effect
from tests.sysid.test_residue import plant

FORCE, SPEED = 0.003, 0.05


def _accepted(model):
    base = base_of(model)
    return explained(model, base, Chosen("coulomb_friction")), base


@pytest.fixture(scope="module")
def imitated():
    model = plant(lambda _, u: -FORCE * (1 + 2 * ca.exp(-((u / SPEED) ** 2))) * ca.tanh(u / 2e-3))
    return model, *_accepted(model)


def test_dry_friction_that_is_there_leaves_nothing():
    model = with_effect(
        {"coulomb_friction.force1": FORCE, "coulomb_friction.force2": FORCE}, ("coulomb_friction",)
    )
    best, base = _accepted(model)
    assert best.misfit < FLOOR**2
    assert not systematic(model, best, base)


def test_friction_that_falls_with_speed_is_nearly_explained_by_dry_friction(imitated):
    _, best, _ = imitated
    assert best.misfit < 1.0


def test_but_what_is_left_tells_that_it_is_not_that(imitated):
    assert systematic(*imitated)


def test_next_to_nothing_of_a_large_misfit_is_no_pattern(imitated):
    model, best, base = imitated
    whole = replace(base.whole, cost=base.whole.count * (1 + best.misfit / 0.004**2))
    assert not systematic(model, best, replace(base, whole=whole))
