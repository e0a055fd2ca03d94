"""A nominal model is enough if its misfit is noise: small, and depending on nothing."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid.settings import SETTINGS
from rr_opt.sysid.verdict import Identification

NOISIER = (((1 + SETTINGS.misstated) ** 2 - 1) ** 0.5) * 0.99


def explained(left: float, *, complete: bool, certain: bool = False, disagree: bool = False):
    one = SimpleNamespace(excess=left)
    made: Any = SimpleNamespace(
        best=one,
        everywhere=one,
        after=[SimpleNamespace(certain=False), SimpleNamespace(certain=certain)],
        selection=SimpleNamespace(complete=lambda _: complete),
        _disagree=disagree,
    )
    return Identification.explained.fget(made)  # pyright: ignore


@pytest.mark.parametrize(
    ("left", "complete", "enough"),
    [(0.0, True, True), (NOISIER, False, True), (2.0, False, False), (2.0, True, True)],
)
def test_misfits(left, complete, enough):
    """Within the form error, or that of slightly larger noise."""
    assert explained(left, complete=complete) is enough


@pytest.mark.parametrize("why", ["certain", "disagree"])
def test_what_noise_does_not_do(why):
    assert not explained(0.0, complete=True, **{why: True})
