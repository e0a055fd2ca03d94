"""No effect stands for a wrong value where every machine of the kind is off by as much."""

from dataclasses import replace

import pytest

from rr_opt.sysid import selection as search
from tests.sysid.made_up import base_of, search_of, with_effect


@pytest.fixture(scope="module")
def shorter():
    """A robot that is shorter than believed, and the fit that tells it."""
    model = with_effect({"c1": 0.144}, ())
    return model, base_of(model)


def test_a_plain_misfit_is_looked_into(shorter, monkeypatch):
    looked = search_of(*shorter)
    asked = []
    monkeypatch.setattr(
        search.Rounds, "next_to", lambda _, best, __: asked.append(best.names) or []
    )
    looked._forward(shorter[1])
    assert asked == [()]


def test_one_that_no_machine_is_free_of_is_not(shorter, monkeypatch):
    monkeypatch.setattr(search.Rounds, "next_to", lambda *_: pytest.fail("looked into"))
    looked = replace(search_of(*shorter), first=0.9 * shorter[0].inexact)
    assert looked._forward(shorter[1]) is shorter[1]
