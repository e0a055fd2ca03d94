"""--out names where results go; a folder is made when there is something to put into it."""

import pytest


@pytest.mark.parametrize("verb", ["maximize-speed", "sweep", "simulate", "export"])
@pytest.mark.parametrize("name", ["", "  "])
def test_an_empty_name_is_refused(run, tmp_path, verb, name):
    done = run(verb, "--out", name)
    assert done.exit_code == 2
    assert done.stderr.startswith("--out: Read an empty name. Expected the name of a folder")
    assert list(tmp_path.iterdir()) == []


def test_the_current_folder_can_be_named(run, tmp_path):
    assert run("simulate", "--seconds", "0.1", "--out", ".").exit_code == 0
    assert (tmp_path / "trajectory.csv").is_file()


@pytest.mark.parametrize(
    "arguments",
    [
        ("simulate", "--amplitude", "1.9"),
        ("simulate", "--seconds", "1e9"),
        ("sweep", "nowhere.yaml"),
        ("export", "--rate", "1"),
    ],
)
def test_a_run_that_fails_leaves_no_folder(run, tmp_path, arguments):
    done = run(*arguments, "--out", "below/res")
    assert done.exit_code == 2
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("target", ["nothing", "out"])
def test_a_link_to_nothing_is_refused_before_anything_is_solved(run, tmp_path, target):
    (tmp_path / "out").symlink_to(target)
    done = run("maximize-speed", "--out", "out")
    assert done.exit_code == 2
    assert "out is not a folder. Give another place with --out." in done.stderr
    assert not done.stdout


@pytest.mark.parametrize("verb", ["maximize-speed", "sweep", "simulate"])
def test_a_file_is_no_folder(run, tmp_path, verb):
    (tmp_path / "file").write_text("")
    done = run(verb, "--out", "file/below")
    assert done.exit_code == 2
    assert "file is not a folder. Give another place with --out." in done.stderr
    assert not done.stdout
