"""Slope, patch, axle and mass do what their definitions say."""

from dataclasses import replace

import numpy as np
import pytest

from rr_lab.case import ENGINES, record
from rr_lab.effects import rig_with
from rr_lab.mujoco.plant import Plant, spin_inertia
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import LONG

ENGINE = pytest.mark.parametrize("engine", ENGINES)
STILL = SineGait(0.0, 1.0)
GAIT = SineGait(0.6, 1.0, 0.2)
FREE = replace(
    LONG, platform1=replace(LONG.platform1, kappa=0.0), platform2=replace(LONG.platform2, kappa=0.0)
)


def recorded(robot, gait, *uses, seconds=2.0, **options):
    return record(robot, gait, seconds, effects=[EffectUse(*use) for use in uses], **options)


@ENGINE
def test_rolls_down_the_slope_it_faces(engine):
    """A straight robot on free wheels: x = g sin(tilt) t^2/2, from when it is let go."""
    uses = ("floor_tilt", {"tilt_x": 0.01, "tilt_y": 0.02}), ("clock_offset", {"offset": -0.2})
    seen = recorded(FREE, STILL, *uses, engine=engine)
    fallen = 9.81 * np.sin(0.01) * (seen.t[-1] - 0.2) ** 2 / 2
    assert seen.values["x"][-1] - seen.values["x"][0] == pytest.approx(fallen, rel=1e-3)
    assert abs(seen.values["y"][-1]) < 1e-4


@ENGINE
def test_a_patch_over_all_the_floor_is_more_friction(engine):
    k = 3.0
    patch = {"multiplier": k, "normal": 0.0, "edge_x": -50.0, "edge_y": 0.0}
    sticky = replace(
        LONG,
        platform1=replace(LONG.platform1, kappa=k * LONG.platform1.kappa),
        platform2=replace(LONG.platform2, kappa=k * LONG.platform2.kappa),
    )
    within = recorded(LONG, GAIT, ("floor_patch", patch), engine=engine)
    same = recorded(sticky, GAIT, engine=engine)
    np.testing.assert_allclose(within.values["x"], same.values["x"], atol=1e-5)


@ENGINE
def test_a_patch_elsewhere_does_nothing(engine):
    patch = {"multiplier": 5.0, "x": 9.0, "y": 9.0, "radius": 1.0}
    there, none = (
        recorded(LONG, GAIT, *uses, engine=engine) for uses in ([("floor_patch", patch)], [])
    )
    np.testing.assert_allclose(there.values["x"], none.values["x"], atol=1e-12)


@pytest.mark.parametrize(
    "use",
    [
        ("com_offset", {"d1": 8e-3, "d2": -5e-3}),
        ("left_right_drag", {"asymmetry1": 0.6, "asymmetry2": 0.3}),
        ("axle_misalignment", {"toe1": 0.02, "toe2": -0.03}),
    ],
    ids=lambda use: use[0],
)
def test_mirror_image(use):
    """The other sign on the mirrored gait makes the mirrored path, and it is not the nominal's."""
    name, values = use
    one = recorded(LONG, GAIT, use)
    other = recorded(
        LONG, SineGait(-0.6, 1.0, -0.2), (name, {key: -value for key, value in values.items()})
    )
    np.testing.assert_allclose(other.values["y"], -one.values["y"], atol=1e-8)
    assert np.abs(one.values["y"] - recorded(LONG, GAIT).values["y"]).max() > 5e-5


@ENGINE
def test_toe_turns_the_axle_counter_clockwise(engine):
    """Towed straight, a robot whose axles are both turned by toe moves along them: to its left."""
    use = ("axle_misalignment", {"toe1": 0.05, "toe2": 0.05})
    seen = recorded(FREE, STILL, use, ("floor_tilt", {"tilt_x": 0.02}), engine=engine)
    moved = [seen.values[name][-1] - seen.values[name][0] for name in ("x", "y")]
    assert np.arctan2(moved[1], moved[0]) == pytest.approx(0.05, abs=2e-4)


def test_left_is_left_on_both_platforms():
    """Left is +90 degrees from the axis: y > 0 in the bodies, whose x is the axis."""
    uses = [
        EffectUse("com_offset", {"d1": 0.01, "d2": 0.02}),
        EffectUse("left_right_drag", {"asymmetry1": 0.5, "asymmetry2": 0.5}),
    ]
    plant = Plant.of(rig_with(LONG, uses), 1e-3)
    for number, d in ((1, 0.01), (2, 0.02)):
        assert plant.model.body(f"platform{number}").ipos[1] == pytest.approx(d, rel=5e-3)
        left, right = (plant.model.body(f"wheel{number}{side}").pos[1] for side in "LR")
        assert left > 0 > right
        left, right = (plant.model.joint(f"roll{number}{side}").damping[0] for side in "LR")
        assert left == pytest.approx(3 * right)


def test_moving_the_mass_keeps_its_inertia():
    """Masses and moments of the parts add up to the robot's."""
    plant = Plant.of(rig_with(LONG, [EffectUse("com_offset", {"d1": 0.01})]), 1e-3)
    body = plant.model.body("platform1")
    rolling = spin_inertia(plant.rig, 1e-3) / LONG.h**2
    one = LONG.platform1
    parts = [(body.mass[0], body.inertia[2], body.ipos[:2])]
    for side in "LR":
        wheel = plant.model.body(f"wheel1{side}")
        at = np.array([one.c, wheel.pos[1]])
        parts.append((wheel.mass[0] + rolling, wheel.inertia[2], at))
    mass = sum(m for m, _, _ in parts)
    centre = sum(m * at for m, _, at in parts) / mass
    about = sum(I + m * np.sum((at - centre) ** 2) for m, I, at in parts)
    assert mass == pytest.approx(one.m)
    np.testing.assert_allclose(centre, [one.joint_to_centre, 0.01], atol=1e-12)
    assert about == pytest.approx(one.I)
