"""The stage that is lit is the one where the fault was put, and none is lit where there is none."""

from dataclasses import replace

import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.stages.stages import stages
from rr_opt.model.robot import EffectUse
from tests.sysid.stages.world import fitted, recorded

FAULTS = {
    "measurement": {"marker_offset.dx": 0.004, "marker_offset.dy": -0.004},
    "actuation": {"servo_lag.tau": 0.01},
    "constraint_axle1": {"axle_misalignment.toe1": 0.01, "axle_misalignment.toe2": 0.0},
    "constraint_axle2": {"axle_misalignment.toe1": 0.0, "axle_misalignment.toe2": 0.01},
    "rolling": {"coulomb_friction.force1": 0.004, "coulomb_friction.force2": 0.004},
    "yaw": {"left_right_drag.asymmetry1": 0.4, "left_right_drag.asymmetry2": 0.0},
    "mass": {"com_offset.d1": 0.01, "com_offset.d2": 0.0},
    "floor": {"floor_tilt.tilt_x": 0.001, "floor_tilt.tilt_y": -0.0005},
}


@pytest.mark.parametrize("channel", FAULTS)
def test_the_stage_with_the_fault_is_lit(channel):
    model = recorded(FAULTS[channel], seed=1)
    found = stages(model, fitted(model))
    assert [stage.channel for stage in found if stage.guilty] == [channel]


def test_a_clock_that_is_off_is_measurement_and_not_the_servo():
    model = recorded({"clock_offset.offset": 0.01}, seed=2)
    found = stages(model, fitted(model))
    assert [stage.channel for stage in found if stage.guilty] == ["measurement"]
    assert "+10.0 ms" in next(stage.where for stage in found if stage.guilty)


@pytest.mark.parametrize("seed", range(2))
def test_no_stage_is_lit_where_nothing_is_wrong(seed):
    model = recorded({}, seed)
    assert not any(stage.guilty for stage in stages(model, fitted(model)))


def test_a_robot_that_has_dry_friction_already_is_not_tested():
    model = recorded({}, seed=3)
    fit = fitted(model)
    friction = EffectUse("coulomb_friction", {"force1": 0.01, "force2": 0.01})
    robot = replace(model.experiment.robot, physics=(friction,))
    known = RollerRacer(replace(model.experiment, robot=robot))
    assert stages(known, fit) == ()
