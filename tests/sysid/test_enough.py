"""When a search is content with a model, and when a further effect is needed."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid import selection
from rr_opt.sysid.selection import Selection

NOTHING: Any = SimpleNamespace(choices=())
SLIP: Any = SimpleNamespace(choices=("slip",))


def searching(**known: Any) -> Any:
    search: Any = Selection.__new__(Selection)
    search.complete = lambda _: True
    vars(search).update({"foreseen": True, "dependences": [], **known})
    return search


@pytest.mark.parametrize(
    ("known", "enough"),
    [
        ({}, True),
        ({"foreseen": False}, False),
        ({"dependences": [SimpleNamespace(certain=False)]}, True),
        ({"dependences": [SimpleNamespace(certain=False), SimpleNamespace(certain=True)]}, False),
    ],
)
def test_beside_the_nominal_model_nothing_may_be_certainly_missing(known, enough):
    search = searching(**known)
    assert search._enough(NOTHING) is enough
    assert search._enough(SLIP)


@pytest.mark.parametrize(
    ("close", "complete", "needed"),
    [(False, False, True), (False, True, True), (True, False, False), (True, True, True)],
)
def test_what_may_be_form_error_has_to_be_removed_altogether(close, complete, needed):
    search = searching(
        _better=lambda *_: True, _close=lambda *_: close, complete=lambda _: complete
    )
    assert search.needed(SimpleNamespace(excess=0.0), SLIP) is needed


@dataclass(frozen=True, eq=False)
class Made:
    choices: Any
    elpd: float
    given_up: bool = False

    @property
    def fit(self) -> Any:
        return SimpleNamespace(deviance=-2 * self.elpd)


def test_what_is_asked_again_starts_from_there_once(monkeypatch):
    """Its first fit, from the nominal model, may have ended in another minimum."""
    best, values = Made(("lag", "play"), -10.0), [{"clock.offset": 0.02}]
    astray, right = Made(("clock", "play"), -90.0, True), Made(("clock", "play"), -5.0)
    asked = []
    monkeypatch.setattr(
        selection, "fitted", lambda model, key, _, guesses, rival: asked.append(guesses) or right
    )
    search = searching(tried={("clock", "play"): astray}, model=None, _compared=set())
    assert search._asked(("play", "clock"), values, best) is right
    search.tried["clock", "play"] = astray
    assert search._asked(("play", "clock"), values, best) is astray
    assert asked == [values]
