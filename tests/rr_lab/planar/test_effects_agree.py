"""What is hidden does in the planar engine what it does in MuJoCo, and is seen as well."""

from dataclasses import replace

import pytest

from rr_lab.case import ENGINES, Plan
from rr_lab.effect_size import EffectSize
from rr_lab.effects import EVERY, effect_named
from rr_lab.random_case import bare_case
from rr_opt.model.experiment import Noise
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import SHORT

PLAN = Plan("run.csv", SineGait(0.7, 1.2, 0.15), 4.0, "running", "fit", (0.1, 0.0, 0.3))
CASE = replace(bare_case(1, 4.0, robot=SHORT), plans=(PLAN,), noise=Noise(1e-3, 3e-3), robot=SHORT)

SMOOTH = 0.01
USES = (
    ("servo_lag", {"tau": 0.03}, SMOOTH),
    ("servo_lag", {"tau": 0.03, "beta": 1e-3}, SMOOTH),
    ("servo_lag/second_order", {"tau": 0.03, "zeta": 0.7}, SMOOTH),
    ("servo_lag/p_loop", {"tau": 0.03, "zeta": 0.7}, SMOOTH),
    ("servo_lag/delay", {"delay": 0.02}, SMOOTH),
    ("servo_rate_limit", {"rate_limit": 2.5}, SMOOTH),
    ("servo_backlash", {"width": 0.03}, 0.03),
    ("servo_backlash/frictional", {"width": 0.03, "joint_friction": 0.2}, SMOOTH),
    ("servo_backlash/frictional", {"width": 0.03, "joint_friction": 0.03}, 0.03),
    # The gear has a moment of inertia in MuJoCo.
    (
        "servo_backlash/frictional_compliant",
        {"width": 0.03, "joint_friction": 0.2, "gear_stiffness": 20.0},
        0.05,
    ),
    ("servo_offset", {"offset": 0.03}, SMOOTH),
    ("coulomb_friction", {"force1": 4e-3, "force2": 6e-3}, 0.02),
    ("coulomb_friction/equal", {"force": 4e-3}, 0.02),
    # In MuJoCo turning moves load to the outer wheels.
    ("coulomb_friction/load_proportional", {"mu": 2e-3}, 0.1),
    ("quadratic_drag", {"coefficient_total": 0.4}, SMOOTH),
    ("quadratic_drag/medium_density", {"density": 30.0}, 0.2),  # it drags at wheels there too
    ("left_right_drag", {"asymmetry1": 0.4, "asymmetry2": -0.4}, SMOOTH),
    ("wheel_inertia", {"J": 3e-5}, SMOOTH),
    ("lateral_slip", {"creep_compliance": 0.03}, 0.1),  # MuJoCo's creeps along its wheels too
    ("lateral_slip/creep", {"creep_compliance": 0.02}, 0.05),
    ("lateral_slip", {"mu": 0.03}, 0.1),
    ("lateral_slip/sliding", {"mu": 0.025}, 0.05),
    ("lateral_slip/grazing", {"mu": 0.037}, 0.1),
    ("lateral_slip/sliding_strongly", {"mu": 0.01}, 0.1),
    # MuJoCo's creeps up to the limit, the planar engine's comes near it as a hyperbolic tangent.
    ("lateral_slip/saturating_creep", {"mu": 0.05, "creep_compliance": 0.03}, 0.3),
    ("axle_misalignment", {"toe1": 0.01, "toe2": -0.02}, SMOOTH),
    ("floor_tilt", {"tilt_x": 1e-3, "tilt_y": -5e-4}, SMOOTH),
    ("floor_patch", {"multiplier": 3.0, "x": 0.2, "y": 0.0, "radius": 0.3}, SMOOTH),
    ("floor_patch/edge", {"multiplier": 3.0, "normal": 1.0, "edge_x": 0.2, "edge_y": 0.0}, SMOOTH),
    (
        "floor_patch/strip",
        {"multiplier": 3.0, "normal": 1.0, "edge_x": 0.1, "edge_y": 0.0, "width": 0.15},
        SMOOTH,
    ),
    ("com_offset", {"d1": 5e-3, "d2": -8e-3}, SMOOTH),
    ("marker_offset", {"dx": 5e-3, "dy": 3e-3}, SMOOTH),
    ("clock_offset", {"offset": 0.03}, SMOOTH),
    ("tether", {"stiffness": 0.05, "slack": 0.1, "x": 0.3, "y": 0.3}, 0.02),
    ("stribeck_friction", {"force": 6e-3, "speed": 0.05}, 0.03),
    ("drifting_friction", {"change": 0.8, "time": 5.0}, SMOOTH),
    ("compliant_platform", {"give": 0.3}, 0.05),  # its dampers are each engine's own
    ("wheel_fault", {"force": 0.02}, 0.05),
    ("loose_pin", {"clearance": 3e-3}, 0.5),  # a round hole and a square one; it rattles
    ("dragged_cable", {"force": 8e-3}, SMOOTH),
    ("shifting_load", {"mass": 0.08, "stiffness": 5.0}, 0.03),
)


@pytest.fixture(scope="module")
def gauges():
    return {engine: EffectSize.of(replace(CASE, engine=engine)) for engine in ENGINES}


def test_none_is_left_out():
    assert {effect_named(name).key for name, _, _ in USES} == {effect.key for effect in EVERY}


@pytest.mark.parametrize(("name", "values", "within"), USES, ids=lambda each: str(each)[:40])
def test_seen_as_well(gauges, name, values, within):
    effects = (EffectUse(name, values),)
    one, other = (
        gauges[engine](replace(CASE, effects=effects, engine=engine)) for engine in ENGINES
    )
    assert one > 0.2
    assert other == pytest.approx(one, rel=within)
