"""Of the forms of an effect that predict alike, the one whose values are constant is the answer."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid import diagnose
from rr_opt.sysid.constancy import Constancy

DISAGREE, AGREE, AGREE_BETTER = Constancy(400.0, 100), Constancy(100.0, 100), Constancy(60.0, 200)


def candidate(constancy: Constancy, *effects: str) -> Any:
    return SimpleNamespace(constancy=constancy, effects=effects)


def answer(monkeypatch, best: Any, *alike: Any) -> Any:
    monkeypatch.setattr(diagnose, "weighed", lambda _, one, __: one)
    selection: Any = SimpleNamespace(best=best, alike=lambda: [best, *alike])
    return diagnose.chosen(selection, diagnose.Stopwatch())


@pytest.mark.parametrize("others", [(), (AGREE_BETTER,)])
def test_an_answer_on_whose_values_recordings_agree_stays(monkeypatch, others):
    best = candidate(AGREE, "slip")
    assert answer(monkeypatch, best, *(candidate(one, "slip") for one in others)) is best


def test_another_form_takes_the_place_of_one_whose_values_disagree(monkeypatch):
    best, other, better = (candidate(one, "slip") for one in (DISAGREE, AGREE, AGREE_BETTER))
    assert answer(monkeypatch, best, other, better) is better


def test_another_effect_does_not(monkeypatch):
    best = candidate(DISAGREE, "slip")
    assert answer(monkeypatch, best, candidate(AGREE, "drag")) is best
