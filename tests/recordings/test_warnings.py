"""Every warning has its entry in the one table, and keeps its code wherever it is taken."""

import pickle
import re
from pathlib import Path

import pytest

import rr_opt.recordings
from rr_opt.recordings.warnings import TABLE, notice, size_text

SOURCES = {path: path.read_text() for path in Path(rr_opt.recordings.__file__).parent.rglob("*.py")}
GIVEN = re.compile(r'"([a-z]+\.[a-z]+)"')


def test_codes_are_given_where_they_are_in_the_table_and_nowhere_else():
    table = next(path for path in SOURCES if path.name == "warnings.py")
    given = {
        code for path, text in SOURCES.items() if path != table for code in GIVEN.findall(text)
    }
    assert set(TABLE) == given - {"noise.position", "noise.angle", "noise.torque"}


def test_sentences_end_as_sentences_do():
    for code, entry in TABLE.items():
        text = f"{entry.sentence} {entry.remedy}".strip()
        assert text.endswith((".", "?", "{why}", "{play}", "{remedy}")), code


def test_a_notice_is_its_text_and_keeps_its_code():
    told = notice("gap.many", count=3, most=0.1, total=1.5)
    assert told == "3 gaps are longer than 0.1 s, 1.5 s in all."
    for one in (told, pickle.loads(pickle.dumps(told))):
        assert (one.code, one.kind, one.level) == ("gap.many", "gap", "warning")


@pytest.mark.parametrize(
    ("channel", "size", "text"),
    [("x", 0.00123, "1.23 mm"), ("y", 1.0, "1000 mm"), ("phi", 1.2345, "1230 mrad"), ("t", 2, "2")],
)
def test_a_size_reads_as_it_would_be_written(channel, size, text):
    assert size_text(channel, size) == text


def test_an_error_says_what_was_expected_or_what_to_do():
    errors = {code: one for code, one in TABLE.items() if one.level == "error"}
    assert errors
    assert not [c for c, e in errors.items() if not ("Expected" in e.sentence or e.remedy)]
