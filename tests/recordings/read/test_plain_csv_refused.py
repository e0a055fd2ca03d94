"""A plain CSV that is wrong is refused with file, line and column, and all wrong cells at once."""

from __future__ import annotations

import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.recordings.readers import read_file

ROWS = "t,x,y,psi,phi\n0.00,1,2,3,4\n0.01,1,2,3,4\n0.02,1,2,3,4\n"

CASES = {
    "a word": (ROWS.replace("0.01,1", "0.01,one"), 3, "Read 'one' in column 2 (x)."),
    "two points": (ROWS.replace("0.02,1", "0.02,1.812.3"), 4, "Read '1.812.3' in column 2 (x)."),
    "underscore": (ROWS.replace("0.02,1", "0.02,1_0"), 4, "Read '1_0' in column 2 (x)."),
    "too many cells": (ROWS.replace("2,3,4\n0.02", "2,3,4,5\n0.02"), 3, "Read 6 cells."),
    "a column missing": (ROWS.replace("psi", "heading"), 1, "Expected also `psi`."),
    "a column misspelt": (ROWS.replace("phi", "phi1"), 1, "write `columns: {phi: phi1}`"),
    "a column twice": (ROWS.replace("y,psi", "x,psi"), 1, "Read the column `x` twice."),
    "no header": (ROWS.split("\n", 1)[1], 1, "The first row has numbers"),
    "no rows": ("t,x,y,psi,phi\n", 1, "Read no row with a time."),
    "one row": ("t,x,y,psi,phi\n0,1,2,3,4\n", 1, "Read 1 row with a time."),
    "no times": ("t,x,y,psi,phi\n,1,2,3,4\n,1,2,3,4\n", 1, "Read no row with a time."),
    "one time": ("t,x,y,psi,phi\n1,1,2,3,4\n1,1,2,3,4\n", 1, "Read 1 row with a time."),
    "another table": ("name,age\nA,3\n", 1, "Expected a header row such as `t,x,y,psi,phi`"),
    "an OpenSim table": ("inDegrees=no\nendheader\n", 1, "OpenSim"),
    "bytes 0": (b"t,x,y,psi,phi\n0,1,\x002,3,4\n", 2, "Read a zero byte"),
    "half of UTF-16": ("t,x\n".encode("utf-16") + b"\x00", 2, "not UTF-16"),
}


@pytest.mark.parametrize("case", CASES)
def test_refused(write, case):
    content, line, message = CASES[case]
    path = write(content)
    with pytest.raises(InvalidFileError) as caught:
        read_file(path)
    (issue,) = caught.value.issues
    assert (issue.file, issue.line) == (str(path), line)
    assert message in issue.message


def test_every_wrong_cell_at_once(write):
    text = ROWS.replace("0.00,1,2", "0.00,a,b").replace("0.02,1,2,3,4", "0.02,1,2,3,c")
    with pytest.raises(InvalidFileError) as caught:
        read_file(write(text))
    assert [(issue.line, issue.message.split(".")[0]) for issue in caught.value.issues] == [
        (2, "Read 'a' in column 2 (x)"),
        (2, "Read 'b' in column 3 (y)"),
        (4, "Read 'c' in column 5 (phi)"),
    ]


def test_no_more_than_can_be_read(write):
    rows = "".join(f"{n},a,b,c,d\n" for n in range(1000))
    with pytest.raises(InvalidFileError) as caught:
        read_file(write("t,x,y,psi,phi\n" + rows))
    assert len(caught.value.issues) == 21
    assert "3980 more mistakes" in caught.value.issues[-1].message


@pytest.mark.parametrize("content", [b"", b"\n\n  \n", b"\xef\xbb\xbf", b"# only a remark\n"])
def test_nothing_in_it(write, content):
    with pytest.raises(InvalidFileError):
        read_file(write(content))


def test_no_file(tmp_path):
    for path in (tmp_path / "none.csv", tmp_path, tmp_path / "a\0b"):
        with pytest.raises(InvalidFileError):
            read_file(path)


def test_a_pipe_is_not_waited_for(tmp_path):
    os = pytest.importorskip("os")
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InvalidFileError, match="This is a pipe"):
        read_file(tmp_path / "pipe")
