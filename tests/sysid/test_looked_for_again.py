"""When a search goes on, and when it is made again from another beginning."""

from dataclasses import replace

import pytest

from rr_opt.sysid.candidate import FLOOR, Chosen, rms
from rr_opt.sysid.score_test import Look
from rr_opt.sysid.selection import Rounds, Search
from tests.sysid.made_up import base_of, explained, search_of, with_effect

STICKS = {"coulomb_friction.force1": 0.003, "coulomb_friction.force2": 0.003}


@pytest.fixture(scope="module")
def tried():
    model = with_effect(STICKS, ("coulomb_friction",), seconds=5.0)
    base = base_of(model)
    return model, base, explained(model, base, Chosen("coulomb_friction"))


def test_what_wrong_values_make_up_for_excuses_nothing(tried):
    model, base, found = tried
    search = replace(search_of(model, base, found), first=1e3)
    assert search.rounds.floor(found) == pytest.approx(max(FLOOR, 0.005 * rms(base.misfit)))


@pytest.mark.parametrize(("left", "again"), [(0.2, False), (0.8, True)])
def test_sliding_that_leaves_something_gives_another_a_chance(monkeypatch, tried, left, again):
    model, base, found = tried
    whole = replace(found.whole, cost=found.whole.count * (1 + left**2))
    slides = replace(found, chosen=(Chosen("lateral_slip"),), whole=whole)
    for name in ("_forward", "_backward"):
        monkeypatch.setattr(Search, name, lambda _, best, **__: best)
    search = search_of(model, base, found, slides)
    assert (search._otherwise(slides) is found) == again


def test_what_is_doubtful_is_not_looked_for_again(monkeypatch, tried):
    model, base, found = tried
    whole = replace(found.whole, cost=2 * found.whole.count)
    slides = replace(found, chosen=(Chosen("lateral_slip"),), whole=whole)
    looked = []
    monkeypatch.setattr(Look, "__call__", lambda look: looked.append(look.name) or [])
    monkeypatch.setattr(Rounds, "_over_whole_runs", lambda *_: [])
    search = search_of(model, base, found, slides)
    monkeypatch.setattr(Search, "_backward", lambda _, best: best)
    monkeypatch.setattr(Search, "large", 0.0)
    loud = replace(found, whole=replace(found.whole, cost=1.2 * found.whole.count))
    search.tried[:] = [base, loud, slides]
    search._otherwise(slides)
    assert "floor_patch" in looked
    assert "lateral_slip" not in looked


@pytest.mark.parametrize("better", [False, True])
def test_a_patch_beside_what_a_term_does_better_is_not_looked_for_again(monkeypatch, tried, better):
    model, base, found = tried
    chosen = (Chosen("coulomb_friction"), Chosen("floor_patch"))
    both = replace(found, chosen=chosen, whole=replace(found.whole, cost=2 * found.whole.count))
    looked = []
    monkeypatch.setattr(Rounds, "looked_for", lambda *_: looked.append(1) or [])
    monkeypatch.setattr(Search, "_nameless_does_better", lambda *_: better)
    assert search_of(model, base, found)._looked_for_again(both) is both
    assert bool(looked) != better
