"""A route file is read with units; every mistake in it and in its problem is reported at once."""

import math

import pytest

import rr_opt as rr
from rr_opt.api.files import lint
from rr_opt.files.issue import InvalidFileError

GOOD = """
start: {x: 10 cm, heading: 90 deg}
route:
  - straight: 2 m
  - arc: {radius: 60 cm, angle: -90 deg}
  - to: {x: 3, y: 2 m, heading: 180 deg}
tolerance: {position: 1 cm}
direction: backward
end: running
"""

BAD = """
problem: {limits: {rate: fast}}
start: {x: 1, z: 2}
route:
  - straight: -1 m
  - arc: {radius: 0.6 m}
  - {straight: 1 m, arc: {radius: 1, angle: 1}}
  - spiral: 3
  - arc: {radius: 1 m, angle: 0}
tolerance: {position: 2 kg}
end: soon
"""


def test_a_route_is_read(tmp_path):
    file = tmp_path / "round.yaml"
    file.write_text(GOOD)
    route = rr.load_route(file)
    assert route.start == rr.Pose(0.1, 0.0, math.pi / 2)
    assert route.pieces[0] == rr.Straight(2.0)
    assert route.pieces[1].angle == pytest.approx(-math.pi / 2)
    assert route.pieces[2] == rr.Waypoint(3.0, 2.0, math.pi)
    assert route.tolerance == rr.Tolerance(position=0.01)
    assert (route.direction, route.end, route.name) == ("backward", "running", "round")
    assert route.problem.robot == rr.prototype()
    assert lint(file) == []


def test_every_mistake_at_once(tmp_path):
    file = tmp_path / "bad.yaml"
    file.write_text(BAD)
    places = {issue.path for issue in lint(file)}
    assert places >= {
        "problem.limits.rate", "start.z", "route[0].straight.length", "route[1].arc.angle",
        "route[2]", "route[3].spiral", "route[4].arc", "tolerance.position", "end",
    }  # fmt: skip
    with pytest.raises(InvalidFileError):
        rr.load_route(file)


def test_no_pieces(tmp_path):
    file = tmp_path / "none.yaml"
    file.write_text("route: []\n")
    assert [issue.path for issue in lint(file)] == ["route"]


def test_the_template_and_the_schema(tmp_path):
    (written,) = rr.init("route", tmp_path / "route.yaml")
    assert lint(written) == []
    assert rr.schema("route")["properties"]["route"]["items"]
