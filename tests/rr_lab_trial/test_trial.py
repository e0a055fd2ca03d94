"""A trial goes on where it was stopped, does nothing twice, and counts a crash as a miss."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rr_lab.files import seal_of
from rr_lab.trial import MADE, SAID, SEALS, Trial, basis_of, made_row, said_row, tidy
from rr_lab.trial.draws import Basis, SealedCase
from rr_opt.batch.journal import Journal
from rr_opt.outcome import InputError

STUB = str(Path(__file__).parent / "stub.py")
IDENTITY = {
    "seed": "5eed", "kinds": ["null"], "engines": ["planar"], "code": "none", "version": "0"
}  # fmt: skip
DRAWS = [Basis("5eed", ("null",)).draw(number) for number in range(1, 6)]


def made_up(draw):
    """A case with nothing hidden, made of nothing."""
    answer = {
        "kind": "null", "hidden": [], "spread": 0.0, "effects": [], "stays_visible": {},
        "rms_deviation_from_nominal_in_sigma": {}, "engine": draw.engine, "salt": str(draw.seed),
    }  # fmt: skip
    text = json.dumps(answer)
    return SealedCase({"experiment.yaml": b"robot: {}\n"}, text, seal_of(text), 1.0)


def serial(function, tasks):
    return ((key, function(tasks[key])) for key in tasks)


def tried(folder, how="well", draws=DRAWS, make=made_up, run=serial, limit=60.0):
    """The trial to its end: the numbers made and diagnosed now, and what was opened."""
    trial = Trial(folder, draws)
    with Journal(folder / MADE, IDENTITY) as made, Journal(folder / SAID, IDENTITY) as said:
        now = list(trial.make(made, run, make))
        command = (sys.executable, STUB, how)
        then = list(trial.diagnose(made.rows, said, run, command, limit))
        return now, then, trial.open(made.rows, said.rows, IDENTITY)


def test_all_is_made_and_sealed_before_anything_is_diagnosed(tmp_path):
    order = []

    def watched(function, tasks):
        for key, result in serial(function, tasks):
            order.append((function.__name__, (tmp_path / SEALS).exists()))
            yield key, result

    _, _, opened = tried(tmp_path, run=watched)
    assert order == [("made_up", False)] * 5 + [("diagnose_apart", True)] * 5
    assert [case.outcome for case in opened.cases] == ["right"] * 5


def test_the_seals_are_those_that_sha256sum_checks(tmp_path):
    tried(tmp_path)
    run = subprocess.run(
        ["sha256sum", "--check", SEALS], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert run.stdout.count("OK") == 5


def test_nothing_is_done_twice(tmp_path):
    trial = Trial(tmp_path, DRAWS)
    with Journal(tmp_path / MADE, IDENTITY) as made:
        begun = trial.make(made, serial, made_up)
        assert [next(begun), next(begun)] == [1, 2]
    now, then, _ = tried(tmp_path)
    assert (now, then) == ([3, 4, 5], [1, 2, 3, 4, 5])
    assert tried(tmp_path)[:2] == ([], [])


def test_it_can_be_made_longer(tmp_path):
    tried(tmp_path, draws=DRAWS[:3])
    now, then, opened = tried(tmp_path)
    assert (now, then) == ([4, 5], [4, 5])
    assert len(opened.cases) == 5


@pytest.mark.parametrize(
    ("how", "why"),
    [
        ("crash", "ended with exit code 3"),
        ("late", "ended with exit code 4"),
        ("die", "ended with exit code -6"),
        ("hang", "no answer after 3 s"),
        ("nonsense", "diagnosis.json is missing or unreadable"),
        ("strange", "diagnosis.json is missing or unreadable"),
    ],
)
def test_no_answer_is_a_miss_and_its_output_is_kept(tmp_path, how, why):
    _, _, opened = tried(tmp_path, how, DRAWS[:1], limit=3.0 if how == "hang" else 60.0)
    (miss,) = opened.misses
    assert (miss.outcome, miss.why_none) == ("no answer", why)
    assert f"the stub says {how}" in (tmp_path / "said" / "001" / "output.txt").read_text()


def test_a_process_that_dies_over_a_case_is_a_miss(tmp_path):
    def dying(function, tasks):
        for key in tasks:
            yield key, ("The process died." if function is not made_up else made_up(tasks[key]))

    _, _, opened = tried(tmp_path, draws=DRAWS[:1], run=dying)
    assert opened.misses[0].outcome == "no answer"
    assert (tmp_path / "said" / "001" / "output.txt").read_text() == "The process died."


def test_a_case_that_cannot_be_made_is_told_and_not_diagnosed(tmp_path):
    def make(draw):
        return SealedCase({}, "", "", 1.0, "MuJoCo gave up.") if draw.number == 2 else made_up(draw)

    _, then, opened = tried(tmp_path, make=make)
    assert then == [1, 3, 4, 5]
    assert opened.failed == {"002": "MuJoCo gave up."}


def test_an_answer_that_was_changed_is_found_out(tmp_path):
    tried(tmp_path)
    path = tmp_path / "answers" / "004.json"
    path.write_text(path.read_text().replace("null", "pair"))
    with pytest.raises(InputError, match=r"004.json has the SHA-256 .* has been changed since"):
        tried(tmp_path)


def test_tidied_it_can_still_be_scored(tmp_path):
    _, _, opened = tried(tmp_path)
    tidy(tmp_path, ["001", "002", "003", "005"])
    assert not (tmp_path / "cases").exists()
    assert [path.name for path in (tmp_path / "said").iterdir()] == ["004"]
    assert tried(tmp_path) == ([], [], opened)


def test_what_it_is_drawn_from_is_read_from_the_folder(tmp_path):
    assert basis_of(tmp_path) is None
    Journal(tmp_path / MADE, IDENTITY).__exit__(None, None, None)
    assert basis_of(tmp_path) == Basis("5eed", ("null",), ("planar",))


KILLED = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[2])
from tests.rr_lab_trial.test_trial import made_up, serial, tried

def slow(function, tasks):
    for key, result in serial(function, tasks):
        yield key, result
        if function is not made_up and key == 2:
            print("two are said", flush=True)
            import time
            time.sleep(60)

tried(Path(sys.argv[1]), run=slow)
"""


def test_after_a_kill_it_goes_on(tmp_path):
    root = str(Path(__file__).parents[2])
    process = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(tmp_path), root], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "two are said\n"
    time.sleep(0.2)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    process.stdout.close()
    now, then, opened = tried(tmp_path)
    assert now == []
    # Both were kept before the third was asked for.
    assert then == [3, 4, 5]
    assert len(opened.cases) == 5


@pytest.mark.parametrize(
    ("name", "change", "words"),
    [
        (MADE, {"seal": None}, "line 2: its seal is None"),
        (MADE, {"seconds": "1"}, "line 2: its seconds is '1'"),
        (SAID, {"exit_code": 0.5}, "line 2: its exit_code is 0.5"),
        (SAID, {"claim": {"verdict": 1}}, "line 2: its claim cannot be read"),
        (SAID, {"claim": []}, r"line 2: its claim is \[\]"),
    ],
)
def test_a_row_that_parses_and_is_wrong_is_refused(tmp_path, name, change, words):
    tried(tmp_path)
    path = tmp_path / name
    heading, first, *others = re.sub(r', "crc32": "\w{8}"', "", path.read_text()).splitlines()
    row = json.dumps(json.loads(first) | change)
    path.write_text("\n".join([heading, row, *others]) + "\n")
    read = {MADE: made_row, SAID: said_row}
    for other in {MADE, SAID} - {name}:
        Journal(tmp_path / other, IDENTITY, read=read[other]).__exit__(None, None, None)
    with pytest.raises(InputError, match=words):
        Journal(path, IDENTITY, read=read[name])
    for key in json.loads(first):
        path.write_text(
            f"{heading}\n{json.dumps({k: v for k, v in json.loads(first).items() if k != key})}\n"
        )
        with pytest.raises(InputError, match=f"it has no '{key}'"):
            Journal(path, IDENTITY, read=read[name])


@pytest.mark.parametrize(
    "heading", ["no\n", "[]\n", '{"seed": 1}\n', '{"seed": "1", "kinds": 2}\n']
)
def test_a_heading_that_is_wrong_is_refused(tmp_path, heading):
    (tmp_path / MADE).write_text(heading)
    with pytest.raises(InputError, match=r"damaged in line 1.*--restart"):
        basis_of(tmp_path)
