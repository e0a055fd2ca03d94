"""robot-corrected.yaml is a robot file: it reads back as the robot that was found, with origins."""

from dataclasses import replace

import pytest
import yaml

from rr_opt.effects import OF_ROBOTS
from rr_opt.files.lint import lint_file
from rr_opt.files.record import robot_yaml
from rr_opt.files.robot_file import read_robot
from rr_opt.model.robot import EffectUse
from rr_opt.results.loss import corrected_robot


def written(robot, folder):
    path = folder / "robot-corrected.yaml"
    path.write_text(robot_yaml(robot, "A title.\nAnd more."))
    return path


def _in_full(use):
    neutral = {q.name: q.neutral for q in OF_ROBOTS[use.name].parameters}
    return replace(use, values=neutral | dict(use.values))


@pytest.mark.parametrize("verdict", ["consistent", "parameters", "missing_physics"])
def test_it_reads_back_as_it_was(every, verdict, tmp_path):
    robot = every[verdict].corrected_robot
    path = written(robot, tmp_path)
    assert not [one for one in lint_file(path) if one.level == "error"]
    again = read_robot(path)
    assert again == replace(robot, physics=tuple(_in_full(use) for use in robot.physics))
    assert again.platform1.kappa == 2.1e-5
    assert again.platform2 == every[verdict].experiment.robot.platform2
    assert again.provenance["platform1.kappa"].startswith("fitted: 1.8e-05 to 2.4e-05 N m s")
    assert [use.name for use in again.physics] == (
        ["coulomb_friction"] if verdict == "missing_physics" else []
    )


def test_every_effect_of_the_catalogue_can_be_written(missing, tmp_path):
    values = {
        f"{effect.name}.{q.name}": q.bounds[1] if q.bounds[1] < 10 else q.typical
        for effect in OF_ROBOTS.values()
        for q in effect.parameters
    }
    found = replace(missing.found, values=values, parameters={})
    robot = corrected_robot(missing.experiment, found)
    path = written(robot, tmp_path)
    assert not [one for one in lint_file(path) if one.level == "error"]
    assert {use.name for use in read_robot(path).physics} == set(OF_ROBOTS)


def test_other_readers_of_yaml_see_numbers_too(missing, tmp_path):
    robot = replace(
        missing.corrected_robot, platform2=replace(missing.corrected_robot.platform2, kappa=2e-5)
    )
    data = yaml.safe_load(written(robot, tmp_path).read_text())
    assert data["platform2"]["kappa"] == 2e-5
    assert data["physics"] == [{"name": "coulomb_friction", "force1": 0.0152, "force2": 0.0098}]


def test_effects_that_the_robot_had_stay(missing):
    had = replace(missing.experiment, robot=missing.corrected_robot)
    found = replace(missing.found, values={"m1": 0.5, "servo_offset.offset": 0.02})
    uses = {use.name: dict(use.values) for use in corrected_robot(had, found).physics}
    assert uses["coulomb_friction"]["force1"] == 0.0152
    assert uses["servo_offset"] == {"offset": 0.02}


def test_a_value_stays_within_its_bounds(missing):
    found = replace(missing.found, values={"lateral_slip.mu": 10.000004})
    (use,) = corrected_robot(missing.experiment, found).physics
    assert use.values["mu"] == OF_ROBOTS["lateral_slip"].parameters[1].bounds[1]


@pytest.mark.parametrize("section", ["physics", "physics.lateral_slip"])
def test_the_origin_of_a_section_stays_that_of_what_was_not_fitted(missing, tmp_path, section):
    slip = EffectUse("lateral_slip", {"mu": 0.5})
    said = {"platform1": "measured: CAD", section: "assumed: a guess"}
    robot = replace(missing.experiment.robot, provenance=said, physics=(slip,))
    corrected = corrected_robot(replace(missing.experiment, robot=robot), missing.found)
    origins = read_robot(written(corrected, tmp_path)).provenance
    assert origins["platform1.kappa"].startswith("fitted: ")
    assert origins["physics.coulomb_friction.force1"].startswith("fitted: ")
    assert origins["platform1.c"] == "measured: CAD"
    slips = [text for path, text in origins.items() if path.startswith("physics.lateral_slip")]
    assert slips == ["assumed: a guess"]
