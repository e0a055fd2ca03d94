"""Files are whole or not there, and JSON is strict."""

import json
import math
import os
import socket
import stat
from pathlib import Path

import pytest

from rr_opt.documents.archive import (
    file_for_result,
    folder_for_results,
    remove,
    strict_json,
    whole,
    write_json,
    write_text,
)
from rr_opt.outcome import InputError


def test_a_failed_write_leaves_the_file_that_was_there(tmp_path):
    path = write_text(tmp_path / "a.txt", "old")

    def fail():
        with whole(path) as temporary:
            temporary.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_write_replaces_the_file_and_leaves_no_other(tmp_path):
    path = tmp_path / "a.json"
    write_json(path, {"a": 1})
    write_json(path, {"a": 2})
    assert json.loads(path.read_text()) == {"a": 2}
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_json_cannot_say_is_refused(value):
    with pytest.raises(ValueError, match="JSON"):
        strict_json({"a": value})


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    file = write_text(tmp_path / "file", "")
    with pytest.raises(InputError, match="--out"):
        folder_for_results(file / "below")


def _link(path, tmp_path):
    target = write_text(tmp_path / "target", "kept")
    path.symlink_to(target)


PLACES = {
    "link": _link,
    "dangling link": lambda path, folder: path.symlink_to(folder / "nowhere"),
    "pipe": lambda path, _: os.mkfifo(path),
    "socket": lambda path, _: _bound(path),
    "folder": lambda path, _: path.mkdir(),
}


def _bound(path):
    with socket.socket(socket.AF_UNIX) as one:
        one.bind(str(path))


@pytest.mark.parametrize("kind", PLACES)
def test_only_regular_files_are_replaced_or_removed(kind, tmp_path):
    path = tmp_path / "out"
    PLACES[kind](path, tmp_path)
    before = path.lstat()
    for attempt in (
        lambda: write_text(path, "new"),
        lambda: file_for_result(path),
        lambda: remove(tmp_path, ["target", "out"]),
    ):
        with pytest.raises(InputError, match=r"out is a .*--out"):
            attempt()
    assert path.lstat().st_ino == before.st_ino
    assert stat.S_IFMT(path.lstat().st_mode) == stat.S_IFMT(before.st_mode)
    if kind == "link":
        assert path.read_text() == "kept"


def test_a_device_is_refused():
    with pytest.raises(InputError, match="/dev/null is a device"):
        file_for_result(Path("/dev/null"))
    with pytest.raises(InputError, match="/dev/null is a device"):
        write_text(Path("/dev/null"), "")
    assert stat.S_ISCHR(Path("/dev/null").lstat().st_mode)
