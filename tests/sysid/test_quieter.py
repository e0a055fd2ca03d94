"""The noise that recordings show is used: a search is repeated where it is lower than assumed."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.sysid import diagnose
from rr_opt.sysid.model import ChannelNoise
from tests.sysid.made_up import with_effect


@pytest.mark.parametrize(
    ("found", "levels"),
    [((0.8, 1.2), [0.8, 1.0]), ((1.0, 1.2), None), ((0.99, 0.99), None)],
    ids=["one lower", "higher", "hardly lower"],
)
def test_lower_noise_only(monkeypatch, found, levels):
    monkeypatch.setattr(diagnose, "noise_in", lambda _: [ChannelNoise(level) for level in found])
    search: Any = SimpleNamespace(best=SimpleNamespace(simulated=None))
    again = diagnose._quieter(search)
    assert (again and [one.level for one in again]) == levels


def test_the_next_recording_is_planned_with_the_estimated_noise(monkeypatch):
    planned: list[RollerRacer] = []
    monkeypatch.setattr(RollerRacer, "next_experiment", lambda one, *_: planned.append(one))
    model = with_effect({}, ())
    claimed = model.with_noise([ChannelNoise(0.5)] * len(model.channels))
    diagnose.diagnose(claimed)
    assert planned[0].runs[0].sigma == pytest.approx(model.runs[0].sigma, rel=0.1)
