"""A function that is used often is compiled, and gives the same numbers."""

import casadi as ca
import numpy as np
import pytest

from rr_opt.mechanics import compile_cache
from rr_opt.mechanics.compile_cache import OftenUsed


@pytest.fixture
def function():
    x = ca.SX.sym("x", 2)
    step = ca.Function("often", [x], [ca.vertcat(x[1], ca.sin(x[0]) * x[1] + 0.3)])
    return step.mapaccum(20)


def test_the_numbers_stay_the_same(function):
    often = OftenUsed(function, 1, 3)
    each = [often([0.3, 0.7]) for _ in range(6)]
    assert each[0].shape == (2, 20)
    assert all(np.array_equal(one, each[0]) for one in each)


def test_it_looks_once_and_compiles_once(function, monkeypatch):
    asked = []
    monkeypatch.setattr(compile_cache, "library", lambda *_, make: asked.append(make))
    often = OftenUsed(function, 1, 3)
    for _ in range(6):
        often([0.3, 0.7])
    assert asked == [False, True]


def test_what_was_compiled_is_used_at_once(function, monkeypatch):
    asked = []
    compiled = compile_cache.externals
    monkeypatch.setattr(
        compile_cache, "externals", lambda *a, make: asked.append(make) or compiled(*a, make=True)
    )
    often = OftenUsed(function, 1, 3)
    for _ in range(6):
        often([0.3, 0.7])
    assert asked == [False]
