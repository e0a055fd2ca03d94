"""A ratio that cannot be realised is refused in three sentences that name the way out."""

import pytest

from rr_opt.model.ballast import Loads, inertia_ratio, with_inertia_ratio
from rr_opt.model.robot import Platform, Robot
from rr_opt.outcome import InputError

ROBOT = Robot(
    Platform(0.469, 0.00386, 0.206, 0.02, 0.05, 2e-5),
    Platform(0.250, 0.00175, 0.0641, 0.02, 0.05, 2e-5),
    0.02,
)


def refusal(*arguments) -> str:
    with pytest.raises(InputError) as caught:
        with_inertia_ratio(ROBOT, *arguments)
    return str(caught.value)


@pytest.mark.parametrize("about", ["joint", "centre"])
def test_too_few_loads(about):
    own = inertia_ratio(ROBOT, about)
    text = refusal(0.9 * own, about, "loads")
    assert f"J20/J10 = {0.9 * own:.4g} cannot be reached" in text
    assert f"Ask for a ratio of at least {own:.4g}" in text
    assert "`by: inertia`" in text
    assert with_inertia_ratio(ROBOT, own, about, "loads").platform2.m == pytest.approx(0.250)


def test_inertia_below_what_the_mass_gives_about_the_joint():
    least = 0.25 * 0.0441**2 / ROBOT.platform1.joint_inertia
    text = refusal(0.5 * least, "joint", "inertia")
    assert "It must be positive" in text
    assert f"Ask for a ratio above {least:.4g}" in text
    assert with_inertia_ratio(ROBOT, 1.01 * least, "joint").platform2.I > 0


@pytest.mark.parametrize("ratio", [0.0, -0.2])
def test_inertia_that_is_not_positive_about_the_centre(ratio):
    assert "must be positive" in refusal(ratio, "centre", "inertia")


def test_loads_on_the_axis_reach_only_so_far():
    # About the centre of mass, loads at one point give less than m2 d^2 however many they are.
    onaxis = Loads(distance=0.1, spread=0.0)
    own, most = 0.00175, 0.00175 + 0.25 * (0.1 - 0.0441) ** 2
    J1 = ROBOT.platform1.I
    inside = with_inertia_ratio(ROBOT, (0.1 * own + 0.9 * most) / J1, "centre", "loads", onaxis)
    expected = 0.1 * own + 0.9 * most
    assert inside.platform2.I / own == pytest.approx(expected / own)
    text = refusal(1.01 * most / J1, "centre", "loads", onaxis)
    assert "cannot be reached" in text
    assert "Ask for a smaller ratio" in text


def test_loads_without_any_inertia_about_the_joint():
    nothing = Loads(distance=0.0, spread=0.0)
    assert "Ask for a smaller ratio" in refusal(0.5, "joint", "loads", nothing)


def test_the_robots_own_ratio_needs_no_loads():
    own = inertia_ratio(ROBOT, "centre")
    there = Loads(distance=ROBOT.platform2.joint_to_centre, spread=0.0)
    assert with_inertia_ratio(ROBOT, own, "centre", "loads", there).platform2.m == 0.250
