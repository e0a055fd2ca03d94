"""A first harmonic that may vanish is warned about, where other harmonics would be left."""

import pytest

from rr_opt.files.lint import lint_file
from rr_opt.files.problem_file import read_problem


@pytest.mark.parametrize(
    ("shape", "amplitude", "count"),
    [
        ("fourier", "[0, 1.5]", 1),
        ("free", "[0 deg, 80 deg]", 1),
        ("fourier", "[0.05, 1.5]", 0),
        ("free", "0.3", 0),
        ("sine", "[0, 1.5]", 0),
    ],
)
def test_amplitude_from_0(write, shape, amplitude, count):
    path = write(f"gait: {{shape: {shape}, amplitude: {amplitude}}}\n")
    issues = lint_file(path)
    assert [(issue.level, issue.path) for issue in issues] == count * [
        ("warning", "gait.amplitude")
    ]
    assert all(f"Read an amplitude from 0 of a `{shape}` gait" in one.message for one in issues)
    assert read_problem(path).gait.shape == shape


@pytest.mark.parametrize("high", ["1.5", "0.02"])
def test_what_is_proposed_is_right(write, high):
    (issue,) = lint_file(write(f"gait: {{shape: free, amplitude: [0, {high}]}}\n"))
    proposed = issue.message.split("`")[3]
    assert proposed.startswith("amplitude: ")
    assert lint_file(write(f"gait: {{shape: free, {proposed}}}\n")) == []
