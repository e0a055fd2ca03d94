"""Each effect outside the catalogue changes the motion, and fades as it is made weaker."""

import numpy as np
import pytest

from rr_lab.case import record
from rr_lab.effect_size import scaled_use
from rr_lab.effects import OUTSIDE_NAMES, effect_named
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import LONG

GAIT = SineGait(0.8, 1.0, 0.2)
FADE = 0.02


@pytest.fixture(scope="module")
def nominal():
    return path([])


def path(effects):
    seen = record(LONG, GAIT, 3.0, "running", effects, step=5e-4)
    return np.array([seen.values[name] for name in ("x", "y", "psi", "phi")])


def test_there_are_at_least_five():
    assert len(OUTSIDE_NAMES) >= 5


@pytest.mark.parametrize("name", OUTSIDE_NAMES)
def test_seen_and_fading(name, nominal):
    use = EffectUse(name, {each.name: each.typical for each in effect_named(name).parameters})
    strong, weak = (np.abs(path([scaled_use(use, k)]) - nominal).max() for k in (1.0, FADE))
    assert strong > 2e-3
    assert weak < 0.2 * strong
