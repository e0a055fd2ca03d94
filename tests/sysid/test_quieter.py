"""A search is repeated with the noise that its answer shows, where that is lower."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid import diagnose
from rr_opt.sysid.model import ChannelNoise


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
