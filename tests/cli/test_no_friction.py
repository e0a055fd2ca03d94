"""A robot without friction never settles: what needs a steady state exits 2 and says why."""

import pytest

ROBOT = """
platform1: {m: 0.469, I: 0.00386, c: 0.206, a: 0.020, b: 0.050, kappa: 0}
platform2: {m: 0.250, I: 0.00175, c: 0.0641, a: 0.020, b: 0.050, kappa: 0}
h: 0.020
"""
BARE, WITH_WHEELS = ROBOT, ROBOT + "physics: [{name: wheel_inertia, J: 1.0e-6}]\n"


@pytest.mark.parametrize("text", [BARE, WITH_WHEELS], ids=["bare", "an effect without friction"])
@pytest.mark.parametrize(
    "arguments",
    [
        ("simulate", "robot.yaml", "--start", "steady"),
        ("export", "robot.yaml"),
        ("sweep", "robot.yaml"),
        ("maximize-speed", "robot.yaml"),
    ],
    ids=lambda arguments: arguments[0],
)
def test_exits_2(run, tmp_path, arguments, text):
    (tmp_path / "robot.yaml").write_text(text)
    done = run(*arguments)
    assert done.exit_code == 2, done.output
    assert "Without friction no gait settles" in done.stderr
    assert not done.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["robot.yaml"]


def test_from_rest_it_can_be_driven(run, tmp_path):
    (tmp_path / "robot.yaml").write_text(BARE)
    assert run("simulate", "robot.yaml", "--seconds", "0.2").exit_code == 0
