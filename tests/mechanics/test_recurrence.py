"""A recurrence gives the same states by CasADi's virtual machine and compiled, run by run."""

import shutil

import casadi as ca
import numpy as np
import pytest

from rr_opt.mechanics import recurrence
from rr_opt.mechanics.recurrence import Course, Recurrence


def pendulum():
    x, u, p = ca.SX.sym("x", 2), ca.SX.sym("u", 2), ca.SX.sym("p", 1)
    hit = ca.logic_and(x[0] > 0.5, ca.logic_not(x[1] < 0))
    pushed = ca.logic_or(hit, u[1] > 0.9)
    rate = x[1] + u[0] * (ca.if_else(pushed, -1.0, u[1]) - p * ca.sin(x[0]))
    return ca.Function("pendulum", [x, u, p], [ca.vertcat(x[0] + u[0] * rate, rate)])


def by_hand(run):
    x, rate = run.first
    out = []
    for h, push in run.inputs:
        forced = -1.0 if (x > 0.5 and not rate < 0) or push > 0.9 else push
        rate = rate + h * (forced - run.p[0] * np.sin(x))
        x = x + h * rate
        out.append((x, rate))
    return np.array(out)


def runs():
    rng = np.random.default_rng(3)
    return [
        Course(
            rng.normal(size=2),
            np.column_stack([np.full(n, 0.01), rng.uniform(-1, 1, n)]),
            rng.uniform(1, 9, 1),
        )
        for n in (40, 1, 300, 77, 41, 5, 90, 12, 60)
    ]


@pytest.mark.parametrize("compiled", [False, True])
def test_as_by_hand(compiled, monkeypatch):
    if compiled and not shutil.which("cc"):
        pytest.skip("there is no C compiler")
    monkeypatch.setattr(recurrence, "_LOOK", 0)
    monkeypatch.setattr(recurrence, "_PAYS", 0 if compiled else 10**9)
    found = Recurrence(pendulum())
    for run, states in zip(runs(), found(runs()), strict=True):
        np.testing.assert_allclose(states, by_hand(run), rtol=0, atol=1e-12)
    assert found([]) == []


def test_compiled_once_it_pays(monkeypatch):
    asked = []
    monkeypatch.setattr(recurrence, "library", lambda *_, make: asked.append(make))
    monkeypatch.setattr(recurrence, "_LOOK", 1000)
    monkeypatch.setattr(recurrence, "_PAYS", 2000)
    found = Recurrence(pendulum())
    for _ in range(5):
        found(runs())
    assert asked == [False, True]
