"""Robots whose file lists effects: they are part of the nominal model, with values to be fitted."""

from dataclasses import replace

import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.robot import EffectUse
from rr_opt.sysid.diagnose import diagnose
from rr_opt.sysid.model import Request
from tests.sysid.made_up import ROBOT, experiment, recorded, whole

USES = {
    "coulomb_friction": {"force1": 0.003, "force2": 0.003},
    "lateral_slip": {"creep_compliance": 0.02, "mu": 10.0},
    "floor_patch": {"multiplier": 3.0, "normal": 0.3, "edge_x": 0.1, "edge_y": 0.0},
}


def made(name, values):
    given = experiment()
    listed = replace(ROBOT, physics=(EffectUse(name, values),))
    empty = RollerRacer(replace(given, robot=listed))

    def predict(run, start):
        plain = Request(whole(empty, run), {}, start[:4])
        return empty.predicted(replace(plain, state=empty.converted(plain, ())), ())

    return recorded(empty.experiment, predict, 4)


@pytest.mark.parametrize("name", USES)
def test_a_robot_that_is_as_its_file_says(name):
    found = diagnose(made(name, USES[name]))
    assert found.verdict == "consistent"


def test_a_stated_strength_that_is_wrong():
    model = made("coulomb_friction", USES["coulomb_friction"])
    stated = {"force1": 0.001, "force2": 0.001}
    listed = replace(ROBOT, physics=(EffectUse("coulomb_friction", stated),))
    found = diagnose(RollerRacer(replace(model.experiment, robot=listed)))
    assert found.verdict == "parameters"
    assert "force1 of Coulomb friction" in found.summary
    for one in stated:
        value = found.parameters[f"coulomb_friction.{one}"]
        assert value.low < 0.003 < value.high < 0.004
