"""A patch that follows a few recordings whatever they lack is not taken at its word."""

import pytest

from rr_opt.sysid import selection as search
from rr_opt.sysid.candidate import Chosen, Explanation
from tests.sysid.made_up import base_of, search_of, with_effect


@pytest.fixture(scope="module")
def base():
    model = with_effect({}, ())
    return model, base_of(model)


@pytest.mark.parametrize(("across", "begins"), [(0.0, "floor_patch"), (9.0, "coulomb_friction")])
def test_the_search_begins_again_where_recordings_speak_against_one_another(
    base, across, begins, monkeypatch
):
    model, alone = base
    patch, friction = (
        Explanation((Chosen(name),), alone.windows, alone.whole)
        for name in ("floor_patch", "coulomb_friction")
    )
    monkeypatch.setattr(search, "left_out", lambda _: across)
    monkeypatch.setattr(search.Search, "_forward", lambda _, best, **__: best)
    found = search_of(model, alone, patch, friction)._otherwise(patch)
    assert found.names == (begins,)
