"""The program that diagnoses is given the recordings, and nothing that tells what is hidden."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from rr_lab.random_case import Request
from rr_lab.trial import draws
from rr_lab.trial.draws import Draw, make
from rr_lab.trial.isolation import COMMAND, Task, diagnose_apart

STUB = str(Path(__file__).parent / "stub.py")
DRAW = Draw(17, "single:coulomb_friction", 10.0, 0.0, 987654321012345, "planar")


def command(how):
    return (sys.executable, STUB, how)


@pytest.fixture(scope="module")
def made():
    """A case with dry friction, of runs of 3 s; how detectable it is does not matter here."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(draws, "_remains", lambda case: {"coulomb_friction": 1.0})
        return make(DRAW, seconds=3.0)


@pytest.fixture(scope="module")
def seen(made):
    """All that the program could see."""
    said = diagnose_apart(Task(made.files, command("tell")))
    return json.loads(said.files["diagnosis.json"])


def test_it_sees_the_files_of_the_folder_alone(made, seen):
    files = {Path(name).name for name in seen["files"]}
    assert files - set(made.files) <= {"output.txt"}
    runs = (f"run{n:02d}.csv" for n in range(1, len(made.files)))
    assert set(made.files) == {"experiment.yaml", *runs}


def test_its_folder_is_named_alike_for_every_case(seen):
    assert Path(seen["cwd"]).name == "recordings"
    out = str(Path(seen["cwd"]).parent / "said")
    assert seen["words"][1:] == [seen["cwd"], "--out", out]


def test_nothing_tells_kind_seed_number_or_answer(made, seen):
    hidden = json.loads(made.answer)
    everything = json.dumps([seen["words"], seen["files"], sorted(seen["environment"])]).lower()
    for word in (str(DRAW.seed), "coulomb", "friction", "single", "visib", "answer",
                 made.seal, hidden["salt"], "case-"):  # fmt: skip
        assert word.lower() not in everything, word


def test_no_variable_but_a_few_is_handed_on(seen, monkeypatch, made):
    monkeypatch.setenv("RR_OPT_ANSWER", "coulomb_friction")
    again = json.loads(diagnose_apart(Task(made.files, command("tell"))).files["diagnosis.json"])
    assert "RR_OPT_ANSWER" not in again["environment"]


def test_experiment_yaml_is_that_of_the_same_case_with_nothing_hidden(made):
    """Kinds cannot be told from it: robot, gaits, noise and uncertainties are drawn before."""
    null = make(Draw(17, "null", None, 0.0, DRAW.seed, "planar"), seconds=3.0)
    assert made.files["experiment.yaml"] == null.files["experiment.yaml"]
    assert made.files["run01.csv"] != null.files["run01.csv"]


def test_the_answer_has_a_random_word_so_that_a_guess_cannot_be_checked(made):
    case = Request(seed=DRAW.seed, seconds=1.0).case()
    texts = {draws._answer_text(case, DRAW) for _ in range(3)}
    assert len(texts) == 3


def test_python_takes_nothing_from_the_folder():
    assert "-I" in COMMAND


def test_time_and_exit_code_are_told(made):
    said = diagnose_apart(Task(made.files, command("well")))
    assert (said.exit_code, said.timed_out) == (0, False)
    assert said.cpu > 0
    assert said.wall > 0
    assert said.files["report.html"] == b"a page"
    assert said.files["output.txt"].decode() == "the stub says well\n"


def test_a_crash_is_told_with_its_output(made):
    said = diagnose_apart(Task(made.files, command("crash")))
    assert said.exit_code == 3
    assert list(said.files) == ["output.txt"]
    assert b"the stub says crash" in said.files["output.txt"]


def test_a_program_that_does_not_end_is_ended():
    said = diagnose_apart(Task({}, command("hang"), limit=1.0))
    assert said.timed_out
    assert said.exit_code == -9
    assert said.wall < 10


def test_it_ends_with_the_process_that_started_it(made, tmp_path):
    """The system closes what is written to its standard input, however that process ends."""
    for name, content in made.files.items():
        (tmp_path / name).write_bytes(content)
    command = (*COMMAND, str(tmp_path), "--out", str(tmp_path / "out"))
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        assert b" s  " in running.stderr.readline()
        running.stdin.close()
        assert running.wait(10) == 1
    assert not (tmp_path / "out" / "diagnosis.json").exists()
