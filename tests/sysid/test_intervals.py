"""Intervals know noise, what no model has exactly, and what held-out recordings say."""

import numpy as np
import pytest

from rr_opt.machines.racer import racer
from rr_opt.sysid.candidate import nominal, whole
from rr_opt.sysid.values import estimates
from tests.sysid.made_up import base_of, with_effect


@pytest.fixture(scope="module")
def fitted():
    model = with_effect({}, (), seconds=20.0)
    return model, base_of(model).whole


def widths(fitted, held=0.0):
    return {name: one.high - one.low for name, one in estimates(*fitted, held).items()}


def test_wider_with_what_no_model_has(fitted, monkeypatch):
    usual = widths(fitted)
    monkeypatch.setattr(racer, "INEXACT", 0.05)
    wider = widths(fitted)
    assert all(wider[name] >= usual[name] * (1 - 1e-9) for name in usual)
    assert max(wider[name] / usual[name] for name in usual) > 1.1


def test_that_is_half_a_thousandth_of_the_way(fitted):
    model, fit = fitted
    piece = next(iter(fit.starts))
    path = model.respond(piece, fit.values, (), fit.starts[piece]).predicted
    off = model._stray(path)
    assert np.hypot(*off[-1, :2]) == pytest.approx(
        5e-4 * np.hypot(*(path[-1, :2] - path[0, :2])), rel=1e-9
    )
    assert not off[:, 2:].any()


def test_wider_by_the_root_of_what_is_left_of_held_out_recordings(fitted):
    plain, doubted = widths(fitted), widths(fitted, held=0.02)
    assert all(doubted[name] >= plain[name] * (1 - 1e-9) for name in plain)
    # Of what these data see far better than was known before.
    assert max(doubted[name] / plain[name] for name in plain) == pytest.approx(2.0, rel=0.1)


def test_where_nothing_was_fitted_there_is_no_interval(fitted):
    model, _ = fitted
    assert estimates(model, nominal(model, whole(model, [0]))) == {}


def test_wider_by_what_models_of_an_effect_do_not_agree_on(fitted, monkeypatch):
    usual = widths(fitted)
    name, share = next(iter(usual)), 0.3
    monkeypatch.setattr(racer.RollerRacer, "vague", {name: share})
    model, fit = fitted
    wider = estimates(model, fit)[name]
    assert (wider.high - wider.low) / 2 == pytest.approx(
        np.hypot(usual[name] / 2, 1.96 * share * fit.values[name]), rel=1e-3
    )
    assert widths(fitted) | {name: usual[name]} == usual
