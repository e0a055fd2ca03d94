"""A journal keeps every finished row, loses a torn last line alone, and knows its study."""

import json

import pytest

from rr_opt.batch.journal import Journal
from rr_opt.outcome import InputError

STUDY = {"input_sha256": "a", "version": "1", "cold": False}


@pytest.fixture
def path(tmp_path):
    return tmp_path / "journal.jsonl"


@pytest.fixture
def three(path):
    """A journal of three rows, as bytes."""
    with Journal(path, STUDY) as journal:
        for case in range(3):
            journal.append(case, {"speed": case / 3})
    return path.read_bytes()


def test_rows_are_found_again(path, three):
    with Journal(path, STUDY) as journal:
        assert journal.rows == {case: {"speed": case / 3} for case in range(3)}


def test_cut_anywhere_only_what_was_not_whole_is_lost(path, three):
    for end in range(len(three)):
        path.write_bytes(three[:end])
        whole = three[:end].count(b"\n")
        with Journal(path, STUDY) as journal:
            assert len(journal.rows) == max(whole - 1, 0)
            journal.append(7, {"speed": 1.0})
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        assert lines[0] == STUDY
        assert lines[-1] == {"case": 7, "speed": 1.0}
        assert len(lines) == max(whole, 1) + 1


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("input_sha256", "the study file or a file that it names changed"),
        ("version", "the version of rr-opt changed"),
        ("cold", "--cold changed"),
    ],
)
def test_rows_of_another_study_are_refused_and_kept(path, three, key, words):
    with pytest.raises(InputError, match=words):
        Journal(path, {**STUDY, key: "other"})
    assert path.read_bytes() == three


def test_restart_forgets(path, three):
    with Journal(path, {**STUDY, "version": "2"}, restart=True) as journal:
        assert journal.rows == {}


def test_a_damaged_one_is_refused(path, three):
    path.write_bytes(three.replace(b'{"case": 1', b'{"case"; 1'))
    with pytest.raises(InputError, match="--restart"):
        Journal(path, STUDY)


def test_two_runs_do_not_share_one(path):
    with Journal(path, STUDY), pytest.raises(InputError, match="Another run"):
        Journal(path, STUDY)
