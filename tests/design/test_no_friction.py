"""A robot without friction is refused before anything is solved."""

from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.robot import EffectUse
from rr_opt.outcome import InputError, Status
from tests.robots import with_friction


def test_refused():
    with pytest.raises(InputError, match="no friction"):
        maximize_speed(replace(PROBLEMS["straight"], robot=with_friction(0.0)))


def test_drag_alone_is_enough():
    drag = EffectUse("quadratic_drag", {"coefficient_total": 0.5})
    robot = replace(with_friction(0.0), physics=(drag,))
    problem = replace(PROBLEMS["straight"], robot=robot, inertia_ratio=None)
    assert maximize_speed(problem).best is not None


def test_dry_friction_alone_may_never_settle():
    # Thrust beyond a force that does not grow with speed accelerates for ever.
    dry = EffectUse("coulomb_friction", {"force1": 0.01, "force2": 0.01})
    robot = replace(with_friction(0.0), physics=(dry,))
    optimum = maximize_speed(replace(PROBLEMS["straight"], robot=robot, inertia_ratio=None))
    assert optimum.status is Status.NOT_CONVERGED
    assert "No steady cycle" in optimum.message
