"""A message says what was read, what was expected and what to do."""

from __future__ import annotations

import pytest

from rr_opt.files.lint import lint_file

MESSAGES = {
    "gait: {amplitud: 1}": (
        "Read the key 'amplitud'. Expected one of: amplitude, period, offset, shape, harmonics, "
        "intervals. Did you mean `amplitude`?"
    ),
    "zzz: 1": (
        "Read the key 'zzz'. Expected one of: robot, gait, inertia_ratio, limits, direction, "
        "objective, robust. Correct it, or delete it."
    ),
    "Direction: forward": "Did you mean `direction`?",
    "gait: {shape: square}": (
        "Read the word 'square'. Expected one of: sine, fourier, free. Correct it, or delete it."
    ),
    "gait: {harmonics: 3}": (
        "Read harmonics of a gait with the shape `sine`. Only a `fourier` gait has harmonics. "
        "Write `shape: fourier`, or delete this key."
    ),
    "gait: {shape: fourier, intervals: 96}": "Only a `free` gait has intervals.",
    "gait: {shape: fourier, harmonics: 17}": (
        "Read 17. Expected a whole number from 1 to 16. Write it without a unit, or delete the key."
    ),
    "gait: {shape: fourier, harmonics: 2.5}": "Read 2.5. Expected a whole number from 1 to 16.",
    "gait: {shape: free, intervals: 97}": "Read 97. Expected an even number from 16 to 384.",
    "gait: {shape: free, intervals: 14}": "Read 14. Expected an even number from 16 to 384.",
    "gait: {shape: free, intervals: true}": "Read true. Expected an even number from 16 to 384.",
    "direction: 4": "Read 4. Expected one of: forward, backward, either.",
    "inertia_ratio: {bounds: 0.2, about: center}": (
        "Read the word 'center'. Expected one of: joint, centre. Did you mean `centre`?"
    ),
    "inertia_ratio: {by: loads}": "This key is missing. Add it. Expected: J20/J10, dimensionless.",
    "inertia_ratio: {bounds: 0.2, by: loads, loads: {whole: 1}}": (
        "Read 1. Expected true or false. Write it, or delete the key."
    ),
    "gait:": "Read nothing. Expected keys with values under it. Write it, or delete the key.",
    "gait: {period: -1}": (
        "Read -1. Expected a number in s at least 0.01. Write for example `1.2 s`."
    ),
    "gait: {period: -2 min}": (
        "Read '-2 min', -120 s. Expected a number in s at least 0.01. Write for example `1.2 s`."
    ),
    "gait: {period: .inf}": "Read .inf. Expected a number in s at least 0.01.",
    "gait: {offset: .inf}": "Read .inf. Expected a number in rad that is finite.",
    "gait: {offset: 1e308}": "Read 1e+308, more than any quantity. Expected a number in rad",
    "gait: {period: 3 m}": (
        "Read '3 m', a length. Expected a number, or a number with a unit, in s. "
        "Write for example `1.2 s`."
    ),
    "gait: {amplitude: [2, 1]}": (
        "Read [2, 1], whose low end is above its high end. Write [1, 2]."
    ),
    "gait: {offset: [1, 2, 3]}": (
        "Read [1, 2, 3], a list of 3. Expected one number, which fixes it, or a pair [low, high], "
        "which bounds it."
    ),
    "limits: {rate: 0}": (
        "Read 0. Expected a number in rad/s above 0, or .inf for no limit. "
        "Write for example `30 rpm`."
    ),
    "limits: {angle: 200 deg}": (
        "Read '200 deg', 3.49066 rad. Expected a number in rad above 0 and below 3.14159."
    ),
    "limits: {singularity: 0}": "Read 0. Expected a number in m above 0.",
    "robot: 3": (
        "Read 3. Expected the name of a robot file, or the robot itself. "
        "Without this key the robot is the paper's prototype."
    ),
    "robot: nowhere.yaml": (
        "Read 'nowhere.yaml'. There is no such file. Check its name and folder."
    ),
    "robot: .": "Read '.'. This is a folder. Expected a file.",
}


@pytest.mark.parametrize(("text", "message"), MESSAGES.items(), ids=MESSAGES)
def test_message(write, text: str, message: str):
    (issue,) = lint_file(write(text))
    assert issue.level == "error"
    assert message in issue.message


def test_a_long_value_is_cut_and_its_control_characters_escaped(write):
    (issue,) = lint_file(write('direction: "\\e[31m' + "x" * 500 + '"'))
    assert issue.message.startswith("Read the word '\\x1b[31mxxx")
    assert "xxx ... . Expected" in issue.message.replace("....", "... .")
    assert len(issue.message) < 200
