"""When a forward step is settled, and which candidate it takes."""

from dataclasses import dataclass
from typing import Any

import pytest

from rr_opt.sysid.model import Choice
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


class Settling(Selection):
    """Drag leaves nothing; nor does tilt, which predicts as in `elpd`."""

    def __init__(self, elpd: float) -> None:
        self.best = Made((), -100.0)  # pyright: ignore
        self.progress = lambda _: None
        self.elpd = elpd

    def complete(self, candidate):
        return True

    def _promising(self) -> Any:
        return ()

    def _scored(self, promising, size) -> Any:
        return [Made((Choice("drag"),), 0.0), Made((Choice("tilt"),), self.elpd)]

    def _extended(self) -> Any:
        raise LookupError("not settled")


@pytest.mark.parametrize(("elpd", "taken"), [(10.0, "tilt"), (-10.0, "drag")])
def test_the_one_that_predicts_better_is_settled_for(elpd, taken):
    selection = Settling(elpd)
    selection._forward()
    assert selection.best.effects == (taken,)


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

        def _proposed(self) -> Any:
            return [Made((Choice("slip"),), alone)]

    selection = Imitated(elpd=-50.0)
    if pairs:
        with pytest.raises(LookupError, match="a pair"):
            selection._forward()
    else:
        selection._forward()
        assert selection.best.effects == ("slip",)
