"""A figure's SVG has the values that it shows, where it shows them."""

import json
import re
from html import unescape

import numpy as np
import pytest

from rr_opt.results.figures import style


def told(drawn):
    svg = style.svg(drawn)
    found = re.search(r'<metadata id="readout">(.*?)</metadata>', svg, re.DOTALL)
    return svg, json.loads(unescape(found[1])) if found else []


def drawn_place(svg, axes, k):
    """Where a line that is the only one of its colour begins, in shares of the picture."""
    width, height = map(float, re.search(r'viewBox="0 0 (\S+) (\S+)"', svg).groups())
    path = re.search(r'<path d="M([^ L]+) ([^ L]+)L[^"]*"[^>]*stroke: #123456', svg)
    return float(path[1]) / width, float(path[2]) / height


def test_a_line_is_told_where_it_is_drawn():
    with style.styled():
        drawn = style.figure()
        above, below = drawn.subplots(2, 1, sharex=True)
        x = np.linspace(1, 3, 50)
        above.plot(x, x**2, color="#123456", label="a < b & c")
        above.axhline(4)
        below.plot(x, 10**x)
        below.set_yscale("log")
        below.set_xlabel("time, s")
        above.set_ylabel("way, m")
        svg, (first, second) = told(drawn)
    (line,) = first["lines"]
    assert line["label"] == "a < b & c"
    assert line["y"] == pytest.approx(x**2, rel=1e-4)
    assert (first["x"]["label"], second["x"]["label"]) == ("time, s", "time, s")
    left, top, right, bottom = first["box"]
    (x0, x1), (y0, y1) = first["x"]["at"], first["y"]["at"]
    across = left + (right - left) * (line["x"][0] - x0) / (x1 - x0)
    down = bottom - (bottom - top) * (line["y"][0] - y0) / (y1 - y0)
    assert (across, down) == pytest.approx(drawn_place(svg, first, 0), abs=2e-3)
    # A scale that is not linear is told in steps.
    at = np.array(second["y"]["at"])
    assert len(at) > 2
    assert np.diff(np.log(at)) == pytest.approx(np.full(len(at) - 1, np.log(at[1] / at[0])), 1e-2)


def test_cells_bands_and_the_names_of_lanes():
    with style.styled():
        drawn = style.figure()
        top, bottom = drawn.subplots(2, 1)
        z = np.array([[1.0, np.nan, 3.0], [4.0, 5.0, 6.0]])
        style.cells(top, np.arange(3.0), np.arange(2.0), z, "speed, mm/s")
        bottom.fill_between([0, 1, 2], [0, 0, 0], [1, 2, 1], label="_as found")
        style.lanes(bottom, ["run01", "run02"])
        _, (first, second) = told(drawn)
    assert first["cells"]["z"] == [[1, None, 3], [4, 5, 6]]
    (band,) = second["bands"]
    assert band["label"] == "as found"
    assert [1, 2] in band["points"]
    assert second["y"]["words"] == [[0, 1], ["run01", "run02"]]


def test_a_figure_with_nothing_to_tell_has_no_metadata():
    with style.styled():
        drawn = style.figure()
        drawn.add_subplot().axvline(1)
        assert told(drawn)[1] == []
