"""What keeps the laboratory from working is told in a sentence, not by a traceback."""

import sys

import pytest

from rr_lab.case import record
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from rr_opt.outcome import InputError, NotConvergedError
from tests.rr_lab.reduced import LONG

GAIT = SineGait(0.6, 1.0)


def test_mujoco_is_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(InputError, match=r"pip install 'rr-opt\[lab\]'"):
        record(LONG, GAIT, 1.0)


def test_simulation_breaks_down(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(NotConvergedError, match="diverged"):
        record(LONG, GAIT, 1.0, effects=[EffectUse("compliant_platform", {"give": 1e-9})])
    assert list(tmp_path.iterdir()) == []


def test_planar_motion_is_lost():
    with pytest.raises(NotConvergedError, match="diverged"):
        record(LONG, SineGait(100.0, 0.01), 1.0, engine="planar")


@pytest.mark.parametrize(
    ("name", "values", "expected"),
    [
        ("gremlins", {}, "cannot hide"),
        ("servo_lag", {}, "is missing its parameter tau"),
        ("servo_lag", {"tau": 0.1, "width": 1.0}, "no parameter width"),
    ],
)
def test_wrong_effects(name, values, expected):
    with pytest.raises(InputError, match=expected):
        record(LONG, GAIT, 1.0, effects=[EffectUse(name, values)])
