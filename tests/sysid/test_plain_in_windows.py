"""What windows plainly show is gone on from, though a fit over whole runs did not keep it."""

from dataclasses import replace

import pytest

from rr_opt.sysid.candidate import Chosen
from rr_opt.sysid.selection import Rounds
from tests.sysid.made_up import base_of, explained, search_of, with_effect

FRICTION = {"coulomb_friction.force1": 0.003, "coulomb_friction.force2": 0.001}
TILT = {"floor_tilt.tilt_x": 0.002, "floor_tilt.tilt_y": 0.001}


@pytest.fixture(scope="module")
def tried():
    model = with_effect(FRICTION | TILT, ("coulomb_friction", "floor_tilt"), seconds=5.0)
    base = base_of(model)
    one = explained(model, base, Chosen("coulomb_friction"))
    two = explained(model, base, Chosen("coulomb_friction"), Chosen("floor_tilt"))
    return model, base, one, two


def leaving(fit, left):
    return replace(fit, cost=fit.count * (1 + left))


@pytest.mark.parametrize(
    ("in_windows", "beside", "ends"),
    [
        (0.3, True, "two"),
        # Nothing beside it gains either: what did not gain is not kept.
        (0.3, False, "base"),
        # Windows show no more than whole runs do.
        (3.0, True, "base"),
    ],
)
def test_forward_from_what_windows_show(monkeypatch, tried, in_windows, beside, ends):
    model, base, one, two = tried
    base = replace(base, windows=leaving(base.windows, 10.0), whole=leaving(base.whole, 20.0))
    one = replace(one, windows=leaving(one.windows, in_windows), whole=leaving(one.whole, 20.0))
    next_to = {base.chosen: [one], one.chosen: [two] if beside else []}
    monkeypatch.setattr(Rounds, "next_to", lambda _, best, __: next_to.get(best.chosen, []))
    search = search_of(model, base)
    monkeypatch.setattr(type(search), "_again", lambda _, less, __: less)
    found = search._forward(base)
    assert found is {"base": base, "two": two}[ends]


def test_what_was_fitted_again_stays(monkeypatch, tried):
    model, base, one, _ = tried
    base = replace(base, whole=leaving(base.whole, 20.0))
    one = replace(one, whole=leaving(one.whole, 20.0))
    again = replace(base, whole=leaving(base.whole, 19.0))
    monkeypatch.setattr(Rounds, "next_to", lambda _, best, __: [one] if not best.chosen else [])
    search = search_of(model, base)
    monkeypatch.setattr(type(search), "_again", lambda *_: again)
    assert search._forward(base) is again
