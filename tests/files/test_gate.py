"""Nothing but a regular file of a size that can be held is read, and nothing else is written."""

import os

import pytest

from rr_opt.batch.journal import Journal
from rr_opt.files.issue import InvalidFileError
from rr_opt.files.lint import lint_file
from rr_opt.files.source import read_content
from rr_opt.outcome import InputError


@pytest.fixture
def odd(tmp_path):
    """Paths of what is no regular file."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "nowhere").symlink_to("gone")
    return {
        "a pipe": tmp_path / "pipe",
        "a folder": tmp_path,
        "a device": "/dev/zero",
        "There is no such file": tmp_path / "nowhere",
        "Too many levels of symbolic links": tmp_path / "loop",
        "embedded null byte": tmp_path / "a\0b",
        "File name too long": tmp_path / ("a" * 300),
    }


def test_what_is_no_file_is_said_and_not_waited_for(odd, tmp_path):
    for said, path in odd.items():
        with pytest.raises(InvalidFileError, match=said):
            read_content(tmp_path / path)


def test_wherever_a_file_names_it(odd, tmp_path):
    named = {said: path for said, path in odd.items() if "\0" not in str(path)}
    for said, path in named.items():
        for text in (
            "robot: '{}'",
            "{{problem: '{}', vary: {{limits.rate: [1]}}}}",
            "{{problem: {{robot: '{}'}}, vary: {{limits.rate: [1]}}}}",
            "{{robot: '{}', noise: {{}}, recordings: []}}",
            "{{noise: {{}}, recordings: [{{file: '{}', gait: {{}}}}]}}",
            "{{noise: {{}}, recordings: [{{file: x, gait: '{}'}}]}}",
            "{{noise: {{}}, recordings: [{{file: x, servo_log: '{}', gait: {{}}}}]}}",
        ):
            file = tmp_path / "given.yaml"
            file.write_text(text.format(path) + "\n")
            told = "\n".join(str(issue) for issue in lint_file(file))
            assert said in told or said == "a folder", (text, told)


def test_a_link_to_a_file_is_read(tmp_path):
    (tmp_path / "file").write_bytes(b"a: 1")
    (tmp_path / "link").symlink_to("file")
    assert read_content(tmp_path / "link") == b"a: 1"


def test_no_more_than_was_asked_for_is_read(tmp_path):
    (tmp_path / "file").write_bytes(bytes(100))
    assert len(read_content(tmp_path / "file", 100)) == 100
    with pytest.raises(InvalidFileError, match="larger than"):
        read_content(tmp_path / "file", 99)


def test_a_journal_behind_a_link_is_not_touched(tmp_path):
    (tmp_path / "target").write_text("kept\n")
    (tmp_path / "journal.jsonl").symlink_to("target")
    with pytest.raises(InputError, match="a symbolic link"):
        Journal(tmp_path / "journal.jsonl", {"a": 1}, restart=True)
    assert (tmp_path / "target").read_text() == "kept\n"
