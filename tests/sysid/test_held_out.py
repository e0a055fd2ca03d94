"""Held-out recordings are asked only where the answer leaves more than machines differ by; each
further effect that the motion alone shows counts against the answer."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid import verdict
from rr_opt.sysid.constancy import Constancy
from rr_opt.sysid.settings import SETTINGS
from rr_opt.sysid.verdict import Identification, remainder_of, wrong_values

FORM, FIRST = 0.02, 100.0


def predicts(
    left: float, gain: float, explained: float = 0.0, form_error: float = 0.0, held: bool = True
) -> float:
    """With what the answer leaves in a held-out run, by how many nats it predicts that, how much of
    it (RMS in sigma) its effects explain, and by how much machines differ from any model."""
    runs = [SimpleNamespace(held_out=False), SimpleNamespace(held_out=held)]
    problem = SimpleNamespace(samples=[10000.0, 10000.0], correlation_times=lambda _: 100.0)
    made: Any = SimpleNamespace(
        selection=SimpleNamespace(
            base=SimpleNamespace(excess=FIRST),
            model=SimpleNamespace(runs=runs, form_error=form_error),
        ),
        best=SimpleNamespace(choices=("a",)),
        final=SimpleNamespace(excess=left),
        everywhere=SimpleNamespace(predictive=[50.0, gain], fit=SimpleNamespace(problem=problem)),
        plain=SimpleNamespace(predictive=[0.0, 0.0]),
        _form_error=FORM,
        _explained=[100.0, explained**2],
    )
    return Identification._predicts.fget(made)  # pyright: ignore


@pytest.mark.parametrize(
    ("left", "gain", "likely"),
    [(1.9, -20.0, 1.0), (2.1, -30.0, 0.0), (2.1, 20.0, 1.0), (50.0, -SETTINGS.evidence, 0.5)],
)
def test_what_the_held_out_recordings_say(left, gain, likely):
    assert predicts(left, gain) == pytest.approx(likely, abs=1e-6)


def test_they_say_less_the_more_machines_may_differ_in_them():
    loss = -2 * SETTINGS.evidence
    # Over 100 samples a correlation time, 0.1 sigma of either kind doubles the variance.
    assert predicts(2.1, loss, form_error=0.1) == pytest.approx(0.5)
    assert predicts(2.1, loss, explained=0.1 / FORM) == pytest.approx(0.5)
    assert predicts(2.1, loss) < 0.01


def test_nothing_is_said_where_none_is_held_out():
    assert predicts(2.1, -100.0, held=False) == 1.0


@pytest.mark.parametrize(("effects", "further"), [("a", 0), ("AB", 0), ("aB", 0), ("abC", 1)])
def test_further_effects_that_the_motion_alone_shows(effects, further):
    """Capitals are effects of the drive, which has a recording of its own."""
    catalogue = {name: SimpleNamespace(upstream=name.isupper()) for name in effects}
    made: Any = SimpleNamespace(
        selection=SimpleNamespace(model=SimpleNamespace(catalogue=catalogue)),
        best=SimpleNamespace(effects=tuple(effects)),
        constancy=Constancy(10.0, 40),
    )
    odds = Constancy(10.0, 40).odds * SETTINGS.further**further
    assert Identification._constant.fget(made) == pytest.approx(odds / (1 + odds))  # pyright: ignore


@pytest.mark.parametrize(
    ("left", "likely"), [(0.0, 1.0), (SETTINGS.none, 1.0), (12.0, 0.5), (50.0, 0.0)]
)
def test_what_is_left_of_all_recordings(left, likely):
    """Not by the values that the fitted ones have: in a held-out one those may go astray."""
    made: Any = SimpleNamespace(
        selection=SimpleNamespace(model=SimpleNamespace(form_error=0.0)),
        everywhere=SimpleNamespace(excess=left),
        plain=SimpleNamespace(excess=FIRST),
        _form_error=FORM,
    )
    assert Identification._as_machines_differ.fget(made) == pytest.approx(  # pyright: ignore
        likely, abs=0.05
    )


def test_a_wrong_value_is_as_sure_as_recordings_agree_on_it(monkeypatch):
    monkeypatch.setattr(verdict, "wrong", lambda _: [SimpleNamespace(name="m1")])
    made: Any = SimpleNamespace(
        best=SimpleNamespace(fit=None), estimates={"m1": None}, constancy=Constancy(10.0, 40)
    )
    (found,) = wrong_values(made)
    assert found.confidence == Constancy(10.0, 40).probability < 0.9


@pytest.mark.parametrize("choices", [(), ("a",)])
def test_what_remains_is_a_share_of_the_first_misfit(choices):
    """Also where values are wrong and no effect is missing."""
    made: Any = SimpleNamespace(
        nominal=SimpleNamespace(excess=50.0),
        selection=SimpleNamespace(
            base=SimpleNamespace(excess=5.0), model=SimpleNamespace(form_error=0.0)
        ),
        final=SimpleNamespace(excess=0.5),
        best=SimpleNamespace(choices=choices),
    )
    left = remainder_of(made)
    assert left.share == Identification.share.fget(made)  # pyright: ignore
    assert (left.size, left.rms, left.share) == ("small", 0.5, pytest.approx(1e-4))


def test_what_remains_is_told_of_the_values_that_predict_best():
    made: Any = SimpleNamespace(
        nominal=SimpleNamespace(excess=50.0),
        selection=SimpleNamespace(
            base=SimpleNamespace(excess=5.0), model=SimpleNamespace(form_error=0.0)
        ),
        final=SimpleNamespace(excess=45.0),
    )
    last: Any = SimpleNamespace(excess=25.0)
    left = remainder_of(made, last)
    assert (left.size, left.rms, left.share) == ("large", 25.0, pytest.approx(0.25))


@pytest.mark.parametrize(("form_error", "size"), [(0.0, "small"), (0.3, "none")])
def test_what_any_two_machines_differ_by_is_no_remainder(form_error, size):
    made: Any = SimpleNamespace(
        nominal=SimpleNamespace(excess=50.0),
        selection=SimpleNamespace(
            base=SimpleNamespace(excess=5.0), model=SimpleNamespace(form_error=form_error)
        ),
        final=SimpleNamespace(excess=0.3),
    )
    assert remainder_of(made).size == size
