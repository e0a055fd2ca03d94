"""A value that is no limit is shown as one, after those that are, and no scale is made of it."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure

from rr_opt.outcome import Status
from rr_opt.results.figures.study import active_areas, grid_of, scale_of, speed, study_map
from rr_opt.results.study import SolvedStudy

ENDLESS = "problem: {gait: {period: 1 s, amplitude: [0.1, 1]}}\nvary:\n"


@pytest.fixture
def result_of(study_of, solved):
    """A study whose cases have one optimum with made-up speeds, and none in the last case."""

    def made(vary: str):
        study = study_of(ENDLESS + vary)
        one = solved(study_of(ENDLESS + "  limits.rate: [3]\n"))[0]
        rows = {}
        for case in range(len(study.problems)):
            faster = replace(one.optimum, speed=0.01 * (1 + case))
            rows[case] = replace(one, optimum=faster)
        rows[len(rows) - 1] = replace(one, status=Status.INFEASIBLE, optimum=None)
        return SolvedStudy(study, tuple(rows.values()))

    return made


def axes():
    return Figure().add_subplot()


def test_named_ticks_in_order_of_size(study_of):
    axis = scale_of(study_of(ENDLESS + "  limits.rate: [.inf, 20 rpm, 10 rpm]\n").axes[0])
    assert [axis.texts[step] for step in axis.order] == ["10 rpm", "20 rpm", "no limit"]
    ax = axes()
    axis.apply(ax)
    ticks = dict(
        zip(ax.get_xticks(), [one.get_text() for one in ax.get_xticklabels()], strict=True)
    )
    assert ticks == {1.0: "10 rpm", 2.0: "20 rpm", 3.0: "no limit"}
    assert ax.get_xlabel() == "rate limit"


def test_texts_say_no_limit(result_of):
    result = result_of("  limits.torque: [.inf, 0.5]\n")
    assert result.inputs_text(0) == "no torque limit"
    assert result.inputs_text(1) == "torque limit 0.5 N m"
    assert "inf" not in result.message


@pytest.mark.parametrize(
    ("rates", "torques", "contours"),
    [
        ("[1, 2, 3, 3.1]", "[0.1, 0.2, 0.3, 0.4]", True),
        ("[1, 2, 3]", "[0.1, 0.2, 0.3, 0.4]", False),
        ("[1, 2, 3, 3.1]", "[0.1, 0.2, 0.3, .inf]", False),
    ],
)
def test_lines_of_equal_speed_only_on_scales_with_cells_enough(result_of, rates, torques, contours):
    result = result_of(f"  limits.rate: {rates}\n  limits.torque: {torques}\n")
    ax = axes()
    study_map(ax, result, grid_of(result))
    assert any(isinstance(one, ContourSet) for one in ax.get_children()) == contours


@pytest.mark.parametrize("draw", [study_map, active_areas])
def test_a_cell_without_optimum_lets_the_hatched_ground_be_seen(result_of, draw):
    result = result_of("  limits.rate: [1, 2]\n  limits.torque: [0.1, .inf]\n")
    ax = axes()
    draw(ax, result, grid_of(result))
    (cells,) = [one for one in ax.collections if one.get_array() is not None]
    ground = [one for one in ax.collections if one.get_hatch()]
    assert ground
    assert all(one.get_zorder() < cells.get_zorder() for one in ground)
    assert np.ma.getmaskarray(np.ma.masked_invalid(cells.get_array())).sum() == 1


def test_the_note_on_what_is_left_out_stands_outside_the_axes(result_of):
    result = result_of("  limits.rate: [1, 2, 3]\n")
    ax = axes()
    speed(ax, result, 0)
    ax.figure.canvas.draw()
    notes = [
        one for one in ax.findobj() if hasattr(one, "get_text") and "left out" in one.get_text()
    ]
    assert [one.get_text() for one in notes] == ["1 case without an optimum is left out"]
    assert notes[0].get_window_extent().y0 >= ax.get_window_extent().y1
