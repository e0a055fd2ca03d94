"""Every wrong option of simulate is reported in one go, in the terms of that option."""

import pytest


def test_all_at_once(run, tmp_path):
    done = run(
        *("simulate", "--amplitude", "-0.3", "--period", "2 kg", "--offset", "north"),
        *("--seconds", "-1", "--rate", "0"),
    )
    assert done.exit_code == 2
    assert done.stderr.splitlines() == [
        "--amplitude: Read '-0.3', -0.3 rad. Expected a number in rad at least 0. "
        "Write for example `30 deg`.",
        "--period: Read '2 kg', a mass. Expected a number, or a number with a unit, in s. "
        "Write for example `1.2 s`.",
        "--offset: Read the text 'north'. Expected a number, or a number with a unit, in rad. "
        "Write for example `10 deg`.",
        "--seconds: Read -1.0. Expected a number in s above 0. Write for example `10`.",
        "--rate: Read 0.0. Expected a number in 1/s above 0. Write for example `100`.",
    ]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("value", ["nan", "inf", "-inf"])
@pytest.mark.parametrize("option", ["--seconds", "--rate"])
def test_numbers_that_are_none(run, option, value):
    done = run("simulate", option, value)
    assert done.exit_code == 2
    assert done.stderr.startswith(f"{option}: Read ")
