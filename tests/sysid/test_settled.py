"""Before an effect is settled for, those that a score test cannot see are fitted too."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid.candidates import Candidate
from rr_opt.sysid.model import Choice, EffectInfo, Form, Quantity
from rr_opt.sysid.selection import Selection


@dataclass(frozen=True)
class Made:
    choices: Any
    elpd: float
    given_up: bool = False

    @property
    def effects(self) -> tuple[str, ...]:
        return tuple(one.name for one in self.choices)

    def predicts_better(self, other) -> bool:
        return self.elpd > other.elpd + 5

    def advances(self, _) -> bool:
        return True


def effect(name: str, *, smooth: bool, guesses: tuple[Mapping[str, float], ...] = ({},)):
    size = Quantity(f"{name}.size", "m", 0.0, 0.3, False, 0.0, 9.0, 0.0)
    form = Form((size,), guesses)
    return EffectInfo(name, "rolling", (form,), smooth)


class Settling(Selection):
    """Drag leaves nothing; so does whatever else is fitted, which predicts as in `elpd`."""

    def __init__(self, elpd: float) -> None:
        self.best = Made((), -100.0)  # pyright: ignore
        self.progress = lambda _: None
        self.elpd, self.guesses = elpd, {}
        known = [effect("drag", smooth=True), effect("creep", smooth=False)]
        known.append(effect("patch", smooth=False, guesses=()))
        catalogue = {one.name: one for one in known}
        self.prepared: list[tuple[str, ...]] = []
        self.model: Any = SimpleNamespace(catalogue=catalogue, prepare=self.prepared.extend)

    def complete(self, candidate):
        return True

    def fitted(self, choices, guesses, parent=None) -> Any:
        self.guesses[choices] = guesses
        return Made(choices, self.elpd)

    def _promising(self) -> Any:
        return ()

    def _scored(self, promising, size) -> Any:
        return [Made((Choice("drag"),), 0.0)] if size == 1 else []

    def _extended(self) -> Any:
        raise LookupError("not settled")


def test_an_effect_without_a_score_is_fitted_from_its_usual_size():
    selection = Settling(elpd=10.0)
    selection._forward()
    assert selection.guesses == {(Choice("creep"),): [{"creep.size": 0.3}]}
    assert selection.prepared == [("creep",)]
    assert selection.best.effects == ("creep",)


def test_a_tie_is_not_settled():
    with pytest.raises(LookupError, match="not settled"):
        Settling(elpd=-1.0)._forward()


@pytest.mark.parametrize(("alone", "pairs"), [(10.0, False), (-99.0, True)])
def test_two_effects_are_tried_where_no_single_one_wins(alone, pairs):
    class Imitated(Settling):
        def complete(self, candidate):
            return "drag" not in candidate.effects

        def _scored(self, promising, size) -> Any:
            if size == 2:
                raise LookupError("a pair is tried")
            return [Made((Choice("drag"),), 0.0)]

        def _extended(self) -> Any:
            return []

        def _proposed(self, parent) -> Any:
            return [Made((Choice("slip"),), alone)]

    selection = Imitated(elpd=-50.0)
    if pairs:
        with pytest.raises(LookupError, match="a pair"):
            selection._forward()
    else:
        selection._forward()
        assert selection.best.effects == ("slip",)


def test_they_are_fitted_in_place_of_each_effect_of_a_pair():
    class Paired(Settling):
        def complete(self, candidate):
            return False

        def _scored(self, promising, size) -> Any:
            return [Made((Choice("drag"), Choice("tilt")), 0.0)] if size == 2 else []

        def _extended(self) -> Any:
            return []

        def _proposed(self, parent) -> Any:
            return []

        def _part(self, whole, key) -> Any:
            return Made(key, -50.0)

    selection = Paired(elpd=10.0)
    selection._forward()
    beside = {(Choice(name), Choice("creep")) for name in ("drag", "tilt")}
    assert set(selection.guesses) == beside
    assert "creep" in selection.best.effects


def test_a_step_that_advances_is_taken_before_one_that_predicts_better():
    class Forked(Settling):
        def complete(self, candidate):
            return False

        def _scored(self, promising, size) -> Any:
            return [Made((Choice("drag"),), 0.0)] if size == 1 else []

        def _extended(self) -> Any:
            return [Standing((Choice("tilt"),), 4.0)]

        def _proposed(self, parent) -> Any:
            return []

    class Standing(Made):
        def advances(self, _) -> bool:
            return False

    selection = Forked(elpd=-50.0)
    selection._forward()
    assert selection.best.effects == ("drag",)


@pytest.mark.parametrize(
    ("whole", "segments", "taken"),
    [(0.8, 1.0, True), (1.1, 0.8, True), (0.85, 0.85, False), (1.1, 0.99, False)],
)
def test_a_step_that_leaves_about_as_much_is_not_taken(whole, segments, taken):
    """Mean squares of .64 and .72 of what there was; a third has to go."""

    def left(excess: float, in_segments: float) -> Any:
        fit: Any = SimpleNamespace(excess=in_segments)
        one = Candidate((), fit)
        one.__dict__["simulated"] = SimpleNamespace(excess=excess)
        return one

    assert left(2 * whole, 3 * segments).advances(left(2.0, 3.0)) == taken

    class Bending(Settling):
        def complete(self, candidate):
            return False

        def _scored(self, promising, size) -> Any:
            return [Advancing((Choice("drag"),), 0.0)] if size == 1 else []

        def _extended(self) -> Any:
            return []

        def _proposed(self, parent) -> Any:
            return []

    class Advancing(Made):
        def advances(self, _) -> bool:
            return taken

    selection = Bending(elpd=0.0)
    selection._forward()
    assert bool(selection.best.choices) == taken
