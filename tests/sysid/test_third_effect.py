"""Three effects are not put together where a term without a name explains all by itself."""

import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.sysid.candidate import Chosen
from rr_opt.sysid.selection import Rounds
from tests.sysid.made_up import base_of, explained, search_of, with_effect

NAME = "rolling_force_curve"
STICKS = (0.0, 0.012, 0.004, 0.003, 0.003)
"""N at speeds from 0 to 0.12 m/s: a friction that falls with speed."""


@pytest.mark.parametrize("has_a_term", [True, False])
def test_no_third_effect_for_what_one_term_does(monkeypatch, has_a_term):
    values = {f"{NAME}.force{k}": force for k, force in enumerate(STICKS)} | {f"{NAME}.speed": 0.12}
    model = with_effect(values, (NAME,))
    base = base_of(model)
    two = explained(model, base, Chosen("coulomb_friction"), Chosen("com_offset"))
    looked = []
    monkeypatch.setattr(Rounds, "next_to", lambda _, best, without: looked.append(best) or [])
    if not has_a_term:
        monkeypatch.setattr(RollerRacer, "nameless", lambda *_: None)
    search = search_of(model, base, two)
    assert search._forward(two) is two
    assert bool(looked) != has_a_term
