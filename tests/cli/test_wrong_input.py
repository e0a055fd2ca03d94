"""A wrong input exits 2 with a message on stderr, an empty stdout and no traceback."""

import pytest


@pytest.mark.parametrize(
    "arguments",
    [
        ("maximize-speed", "nowhere.yaml"),
        ("maximize-speed", "wrong.yaml", "--json"),
        ("sweep", "nowhere.yaml"),
        ("simulate", "nowhere.yaml"),
        ("simulate", "--amplitude", "30 furlongs"),
        ("simulate", "--amplitude", "2.5"),
        ("simulate", "--period", "0"),
        ("simulate", "--seconds", "-1"),
        ("simulate", "--rate", "1e12"),
        ("simulate", "unsolved.json"),
        ("maximize-speed", "--out", "wrong.yaml/below"),
        ("lint", "wrong.yaml"),
        ("schema", "gait"),
        ("maximise",),
    ],
)
def test_wrong_input_exits_2(run, tmp_path, arguments):
    (tmp_path / "wrong.yaml").write_text("gait: {amplitud: 0.5}\n")
    (tmp_path / "unsolved.json").write_text('{"status": "infeasible", "input_sha256": "0"}')
    done = run(*arguments)
    assert done.exit_code == 2, done.output
    assert "Traceback" not in done.output
    if arguments[0] != "lint":
        assert done.stderr
        assert not done.stdout


def test_a_recording_in_the_place_of_a_file_with_keys_is_told(run, tmp_path):
    (tmp_path / "run.csv").write_text("t,x,y,psi,phi\n0,0,0,0,0\n")
    done = run("lint", "run.csv")
    assert done.exit_code == 2
    assert "`rr-opt inspect` reads recordings." in done.output


def test_the_message_names_the_key_and_the_one_meant(run, tmp_path):
    (tmp_path / "wrong.yaml").write_text("gait: {amplitud: 0.5}\n")
    done = run("maximize-speed", "wrong.yaml")
    assert "amplitud" in done.stderr
    assert "amplitude" in done.stderr
