"""Files are whole or not there, and JSON is strict."""

import json
import math

import pytest

from rr_opt.outcome import InputError
from rr_opt.report.archive import folder_for_results, strict_json, whole, write_json, write_text


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
