"""What plainly leaves far more in windows than another effect is not fitted over whole runs."""

from dataclasses import replace

import pytest

from rr_opt.sysid import selection as rounds
from rr_opt.sysid.candidate import Chosen
from rr_opt.sysid.score_test import Promise
from rr_opt.sysid.selection import Rounds
from tests.sysid.made_up import base_of, explained, with_effect

STICKS = {"coulomb_friction.force1": 0.003, "coulomb_friction.force2": 0.003}


@pytest.fixture(scope="module")
def tried():
    model = with_effect(STICKS, ("coulomb_friction",), seconds=5.0)
    base = base_of(model)
    return model, base, explained(model, base, Chosen("coulomb_friction"))


def leaving(fit, left):
    return replace(fit, cost=fit.count * (1 + left))


@pytest.mark.parametrize(
    ("before", "other", "dear", "on"),
    [
        (1.0, 0.1, 0.2, True),
        (1.0, 0.1, 0.4, False),
        # So little is not plain.
        (1.0, 0.001, 0.04, True),
        # What windows do not show adds up over whole runs.
        (0.01, 0.001, 0.1, True),
    ],
)
def test_what_is_plainly_worse_is_not_tried_on(monkeypatch, tried, before, other, dear, on):
    model, base, found = tried
    base = replace(base, windows=leaving(base.windows, before))
    found = replace(found, windows=leaving(found.windows, other))
    slides = Chosen("lateral_slip"), leaving(found.windows, dear)
    came = []
    monkeypatch.setattr(Rounds, "_over_whole_runs", lambda _, __, pairs: came.extend(pairs) or [])
    monkeypatch.setattr(rounds, "carried_out", lambda _: slides)
    promise = Promise(slides[0], 10.0)
    Rounds(model, base.windows, 1.0).fitted(base, [promise], [found])
    assert came == ([slides] if on else [])
