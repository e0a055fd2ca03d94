"""A value of 0 that is known to a factor stays 0: there is no scale to move it by."""

import pytest

from rr_opt.files.machine_file import read_machine_plan
from rr_opt.machines.registry import machine_named

TEXT = """machine: servo
parameters: {{kt: 0.4, R: 4, armature: {armature}, b: 0.004, fc: 0.013}}
recordings: [{{file: run.csv}}]
"""


@pytest.mark.parametrize("armature", [0, 0.002])
def test_only_a_value_that_is_not_0_is_uncertain_by_a_factor(tmp_path, armature):
    (tmp_path / "run.csv").write_text("t,q\n")
    (tmp_path / "experiment.yaml").write_text(TEXT.format(armature=armature))
    plan = read_machine_plan(tmp_path, machine_named("servo"))
    assert ("armature" in plan.experiment.uncertainty) == (armature > 0)
