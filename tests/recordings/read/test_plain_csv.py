"""A plain CSV gives the numbers that stand in it, whatever their order, separator and encoding."""

from __future__ import annotations

import codecs

import numpy as np
import pytest

from rr_opt.model.experiment import Flag, Noise, Recording
from rr_opt.recordings.readers import ReadOptions, read_file

ROWS = """\
t,x,y,psi,phi
0.00,1.5,-2e-3,0.25,0.5
0.01,1.6,.5,+0.26,0.6
0.02,1.7,3,0.27,0.7
"""


def test_as_written(write):
    run = read_file(write(ROWS))
    assert isinstance(run, Recording)
    assert run.name == "run.csv"
    assert run.channels == ("x", "y", "psi", "phi")
    assert run.t.tolist() == [0.0, 0.01, 0.02]
    assert run.values["x"].tolist() == [1.5, 1.6, 1.7]
    assert run.values["y"].tolist() == [-0.002, 0.5, 3.0]
    assert run.values["psi"].tolist() == [0.25, 0.26, 0.27]
    assert run.values["phi"].tolist() == [0.5, 0.6, 0.7]
    assert not any(flags.any() for flags in run.flags.values())
    assert run.doubts == ()
    assert run.source["rate"] == "100 Hz"


def test_any_order_of_columns_and_others_are_told(write):
    rows = "phi,note,torque,y,x,t,psi\n4,,0.5,2,1,0,3\n4.1,in view,0.6,2.1,1.1,0.1,3.1\n"
    run = read_file(write(rows))
    assert [run.values[name].tolist() for name in ("x", "y", "psi", "phi", "torque")] == [
        [1.0, 1.1], [2.0, 2.1], [3.0, 3.1], [4.0, 4.1], [0.5, 0.6],
    ]  # fmt: skip
    assert run.doubts == ("Columns not read: 'note'.",)


def test_sigma_is_the_noise_stated_and_else_unknown(write):
    path = write(ROWS.replace("phi", "phi,torque").replace("\n0", ",0\n0"))
    stated = read_file(path, ReadOptions(Noise(0.001, 0.003, 0.004)))
    assert {name: set(stated.sigma[name]) for name in stated.channels} == {
        "x": {0.001}, "y": {0.001}, "psi": {0.003}, "phi": {0.003}, "torque": {0.004},
    }  # fmt: skip
    assert all(np.isnan(read_file(path).sigma[name]).all() for name in stated.channels)


@pytest.mark.parametrize("cell", ["", "NaN", "nan", " ", '""', "inf", "-inf", "1e999"])
def test_a_drop_out_is_flagged_and_nothing_is_put_in_its_place(write, cell):
    run = read_file(write(ROWS.replace("+0.26", cell)))
    assert run.flags["psi"].tolist() == [0, Flag.MISSING, 0]
    assert np.isnan(run.values["psi"]).tolist() == [False, True, False]
    assert run.flags["phi"].tolist() == [0, 0, 0]
    assert bool(run.doubts) == ("inf" in cell or "999" in cell)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_separators_and_line_ends(write, separator, end):
    run = read_file(write(ROWS.replace(",", separator).replace("\n", end)))
    assert run.values["psi"].tolist() == [0.25, 0.26, 0.27]


@pytest.mark.parametrize("separator", [";", "\t"])
def test_decimal_commas(write, separator):
    run = read_file(write(ROWS.replace(",", separator).replace(".", ",")))
    assert run.t.tolist() == [0.0, 0.01, 0.02]
    assert run.values["y"].tolist() == [-0.002, 0.5, 3.0]


@pytest.mark.parametrize(
    ("mark", "encoding"),
    [
        (b"", "utf-8"),
        (codecs.BOM_UTF8, "utf-8"),
        (codecs.BOM_UTF16_LE, "utf-16-le"),
        (codecs.BOM_UTF16_BE, "utf-16-be"),
        (b"", "utf-16-le"),
        (b"", "utf-16-be"),
        (codecs.BOM_UTF32_LE, "utf-32-le"),
        (b"", "latin-1"),
    ],
)
def test_encodings(write, mark, encoding):
    text = "# Prüfstand 3\n" + ROWS if "16" not in encoding or mark else ROWS
    run = read_file(write(mark + text.encode(encoding)))
    assert run.values["phi"].tolist() == [0.5, 0.6, 0.7]


@pytest.mark.parametrize(
    "text",
    [
        "# " + ROWS,
        "\n\n" + ROWS,
        "# a remark\n" + ROWS,
        "# T = 1 s, amplitude 0.5 rad\n" + ROWS,
        "#" + ROWS.replace("t,x", "t (s),x"),
        ROWS.replace("\n0.01", "\n\n0.01"),
        ROWS.rstrip("\n"),
        ROWS.upper().replace("E", "e"),
        ROWS.replace(",", " , "),
        ROWS.replace("t,x", '"t","x"').replace("1.6", '"1.6"'),
        ROWS.replace("\n", ",\n"),
        ROWS.replace("\n0", ",,,\n0"),
    ],
)
def test_the_same_in_other_dress(write, text):
    run = read_file(write(text))
    assert run.t.tolist() == [0.0, 0.01, 0.02]
    assert run.values["phi"].tolist() == [0.5, 0.6, 0.7]


def test_a_row_that_lacks_its_last_cells_is_told(write):
    run = read_file(write(ROWS.replace(",+0.26,0.6", "")))
    assert run.flags["psi"].tolist() == [0, Flag.MISSING, 0]
    assert run.doubts == (
        "Line 3 has fewer cells than the header. The missing cells were taken as empty.",
    )


def test_a_file_that_ends_within_a_row_loses_that_row_and_says_so(write):
    run = read_file(write(ROWS.removesuffix(",0.27,0.7\n")))
    assert run.t.tolist() == [0.0, 0.01]
    assert run.doubts == ("The file ends in the middle of line 4, which was dropped.",)
