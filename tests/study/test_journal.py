"""A journal keeps every finished row, loses a torn last line alone, and knows its study."""

import json
import re

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
        assert lines[-1] == {"case": 7, "speed": 1.0, "crc32": "5a034d5d"}
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


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (b'{"case"; 1}', "not JSON"),
        (b'{"case": 1, "speed": 0.3', "not JSON"),
        (b"\xff", "not UTF-8"),
        (b"[" * 100_000, "nested too deeply|not JSON"),
        (b"[1]", "not a JSON object"),
        (b'"case"', "not a JSON object"),
        (b'{"speed": 0.3}', "no 'case'"),
        (b'{"case": -1, "speed": 0.3}', "its case is -1"),
        (b'{"case": 3, "speed": 0.3}', "its case is 3, of 3"),
        (b'{"case": 0.7, "speed": 0.3}', "its case is 0.7"),
        (b'{"case": "1", "speed": 0.3}', "its case is '1'"),
        (b'{"case": true, "speed": 0.3}', "its case is True"),
        (b'{"case": 0, "speed": 0.3}', "case 0 already has a row"),
        (b'{"case": 1, "speed": NaN}', "NaN is not a JSON number"),
        (b'{"case": 1, "speed": -Infinity}', "-Infinity is not a JSON number"),
        (b'{"case": 1}', "no 'speed'"),
        (b'{"case": 1, "speed": "fast"}', "could not convert"),
    ],
)
def test_a_line_that_is_no_row_is_refused_with_its_number(line, words, path, three):
    lines = three.splitlines()
    path.write_bytes(b"\n".join([*lines[:2], line, lines[3]]) + b"\n")
    before = path.read_bytes()

    def read(record):
        return {"speed": float(record["speed"])}

    with pytest.raises(InputError, match=words) as refused:
        Journal(path, STUDY, read=read, cases=3)
    assert f"{path} is damaged in line 3: " in str(refused.value)
    assert "--restart" in str(refused.value)
    assert path.read_bytes() == before
    Journal(path, STUDY, read=read, cases=3, restart=True).__exit__(None, None, None)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b'"speed": 0.3', b'"speed": 0.4'),
        (b'"speed": 0.3', b'"speed": -0.3'),
        (b'"case": 1', b'"case": 2'),
        (b'"crc32": "', b'"crc32": "0'),
        (b'"speed"', b'"more": 0, "speed"'),
    ],
)
def test_a_row_that_was_changed_is_refused(old, new, path, three):
    lines = three.splitlines(keepends=True)
    changed = lines[2].replace(old, new)
    assert changed != lines[2]
    path.write_bytes(b"".join([*lines[:2], changed]))
    with pytest.raises(InputError, match="in line 3: it was changed after it was written"):
        Journal(path, STUDY)


def test_rows_have_a_checksum_of_what_was_read_back(path):
    """Of every kind of value that JSON can hold, in its digits and in its order."""
    row = {"b": [1e22, -0.0, 5e-324, 0.1 + 0.2, 2**70], "a": {"é": None, "1": True}, "c": "\n"}
    with Journal(path, STUDY) as journal:
        journal.append(0, row)
    with Journal(path, STUDY) as journal:
        assert journal.rows == {0: row}


def test_rows_of_earlier_versions_have_none(path, three):
    path.write_bytes(re.sub(rb', "crc32": "\w{8}"', b"", three))
    assert b"crc32" not in path.read_bytes()
    with Journal(path, STUDY) as journal:
        assert len(journal.rows) == 3


@pytest.mark.parametrize("heading", [b"[]", b"no", b'"\xff"'])
def test_a_damaged_heading_is_refused(heading, path, three):
    path.write_bytes(three.replace(three.splitlines()[0], heading))
    with pytest.raises(InputError, match="in line 1"):
        Journal(path, STUDY)


def test_two_runs_do_not_share_one(path):
    with Journal(path, STUDY), pytest.raises(InputError, match="Another run"):
        Journal(path, STUDY)
