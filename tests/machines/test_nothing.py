"""A value of 0 that is known to a factor may be anything usual; one known exactly stays 0."""

import pytest

from rr_opt.files.machine_file import read_machine_plan
from rr_opt.machines.equations import parameter_quantity
from rr_opt.machines.registry import machine_named

TEXT = """machine: servo
parameters: {{kt: 0.4, R: 4, armature: {armature}, b: 0.004, fc: 0.013}}
uncertainty: {{armature: {known}}}
recordings: [{{file: run.csv}}]
"""


def uncertainty(folder, armature, known):
    (folder / "run.csv").write_text("t,q\n")
    (folder / "experiment.yaml").write_text(TEXT.format(armature=armature, known=known))
    return read_machine_plan(folder, machine_named("servo")).experiment.uncertainty


@pytest.mark.parametrize("armature", [0, 0.002])
def test_a_factor_leaves_room_for_usual_values(tmp_path, armature):
    known = uncertainty(tmp_path, armature, "unknown")["armature"]
    one = parameter_quantity(machine_named("servo"), "armature", armature, known)
    assert one.low <= armature <= 0.002 < one.high
    assert one.scale == 0.002


@pytest.mark.parametrize("known", ["0", "5 %"])
def test_what_is_known_exactly_is_not_fitted(tmp_path, known):
    assert "armature" not in uncertainty(tmp_path, 0, known)
