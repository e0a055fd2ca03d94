"""An effect has to predict as well as what looks like it, and shares its weight with that."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid import selection
from rr_opt.sysid.model import Choice
from rr_opt.sysid.selection import Selection
from rr_opt.sysid.settings import SETTINGS

RUNS = range(6)


def candidate(*effects: str, elpd: float, deviance: float = 0.0, given_up: bool = False) -> Any:
    """Recordings that are each predicted as well."""
    return SimpleNamespace(
        fit=SimpleNamespace(deviance=deviance),
        choices=effects,
        effects=effects,
        elpd=elpd,
        given_up=given_up,
        predictive=dict.fromkeys(RUNS, elpd / len(RUNS)),
        predicts_better=lambda other: elpd > other.elpd + SETTINGS.evidence,
    )


FRICTION = candidate("friction", elpd=0.0)


class Contest(Selection):
    def __init__(self, *lookalikes: Any, answer: Any = FRICTION) -> None:
        self.best = answer
        self.tried = {answer.choices: answer}
        self.made = lookalikes

    def _lookalikes(self) -> Any:
        return self.made

    def _backward(self, needed: Any) -> None:
        assert needed == self.needed


def contested(*lookalikes: Any) -> Contest:
    search = Contest(*lookalikes)
    search._contest()
    return search


@pytest.mark.parametrize(
    ("gain", "deviance", "winner"),
    [
        *((9.0, 1.0, "cable"), (1.0, -1.0, "cable")),
        *((1.0, 1.0, "friction"), (-1.0, -1.0, "friction"), (-9.0, -1.0, "friction")),
    ],
)
@pytest.mark.parametrize("companions", [(), ("drag",)])
def test_the_better_one_wins_and_if_it_is_hardly_better_only_the_likelier(
    gain, deviance, winner, companions
):
    wax = candidate("wax", elpd=9.0, deviance=-9.0, given_up=True)
    cable = candidate("cable", elpd=gain, deviance=deviance)
    search = Contest(cable, wax, answer=candidate("friction", *companions, elpd=0.0))
    search._contest()
    assert search.best.effects[0] == winner
    assert wax not in [one for one, _ in search.weighted]


@pytest.mark.parametrize("gain", [1.0, -1.0])
def test_both_share_the_weight(gain):
    search = contested(candidate("cable", elpd=gain, deviance=-gain))
    weights = {one.effects[0]: weight for one, weight in search.weighted}
    assert sum(weights.values()) == pytest.approx(1.0)
    assert 0.5 < weights[search.best.effects[0]] < 0.8


def test_none_is_put_beside_itself(monkeypatch):
    form = SimpleNamespace(guesses=({},))
    both = SimpleNamespace(
        choices=(Choice("cable"), Choice("friction")), fit=SimpleNamespace(values={})
    )
    search: Any = Contest(answer=both)
    known = {
        "friction": SimpleNamespace(lookalikes=("cable",)),
        "cable": SimpleNamespace(lookalikes=(), forms=(form,)),
    }
    search.model, search.progress = SimpleNamespace(catalogue=known), lambda _: None
    made = lambda _, choices, *__: SimpleNamespace(choices=choices, given_up=False)  # noqa: E731
    monkeypatch.setattr(selection, "fitted", made)
    assert [one.choices for one in Selection._lookalikes(search)] == [(Choice("cable"),)]


@pytest.mark.parametrize(("given_up", "sizes"), [(True, [2]), (False, [2, 1])])
def test_fewer_effects_are_not_tried_where_more_do_not_fit(monkeypatch, given_up, sizes):
    both = SimpleNamespace(
        choices=(Choice("friction"), Choice("tilt")), fit=SimpleNamespace(values={})
    )
    search: Any = Contest(answer=both)
    known = {
        "friction": SimpleNamespace(lookalikes=("cable",)),
        "cable": SimpleNamespace(forms=(SimpleNamespace(guesses=({},)),)),
        "tilt": SimpleNamespace(lookalikes=()),
    }
    search.model, search.progress = SimpleNamespace(catalogue=known), lambda _: None
    made = lambda _, choices, *__: SimpleNamespace(choices=choices, given_up=given_up)  # noqa: E731
    monkeypatch.setattr(selection, "fitted", made)
    assert [len(one.choices) for one in Selection._lookalikes(search)] == sizes


def test_a_lookalike_that_the_robot_has_is_not_tried():
    one = SimpleNamespace(choices=(Choice("friction"),), fit=SimpleNamespace(values={}))
    search: Any = Contest(answer=one)
    known = {"friction": SimpleNamespace(lookalikes=("cable",))}
    search.model, search.progress = SimpleNamespace(catalogue=known), lambda _: None
    assert [*Selection._lookalikes(search)] == []
