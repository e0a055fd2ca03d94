"""The title of a comparison of waveforms is about the largest family that was solved."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.model.gait import SineGait
from rr_opt.outcome import Status
from rr_opt.results.figures.fastest import draw_shapes
from rr_opt.results.shapes import FastestShapes


def answer(shape: str, speed: float | None, harmonics: int = 1) -> Any:
    """The answer of a family; without a speed, it did not converge."""
    return SimpleNamespace(
        problem=SimpleNamespace(gait=SimpleNamespace(shape=shape, harmonics=harmonics)),
        status=Status.NOT_CONVERGED if speed is None else Status.OPTIMAL,
        speed=speed,
        message="",
        checks=[],
        gait=None,
    )


@pytest.mark.parametrize(
    ("speeds", "title"),
    [
        ((0.1, 0.11, 0.12), "A free gait is 20 % faster than the best sine"),
        ((0.1, 0.11, None), "A gait of 3 harmonics is 10 % faster than the best sine"),
        ((None, 0.11, 0.12), "Waveforms"),
        ((0.1, None, None), "Waveforms"),
    ],
)
def test_title(speeds, title):
    sine, fourier, free = speeds
    families = answer("sine", sine), answer("fourier", fourier, 3), answer("free", free)
    assert FastestShapes("made up", "", families).document().title == title


def test_the_figure_compares_with_no_sine_where_there_is_none():
    sine, fourier, free = answer("sine", None), answer("fourier", 0.11, 3), answer("free", 0.12)
    sine.problem.limits = SimpleNamespace(rate=3.0)
    fourier.gait = free.gait = SineGait(0.5, 1.0)
    drawn = draw_shapes(FastestShapes("made up", "", (sine, fourier, free)))["shapes"]
    assert "120 mm/s" in drawn
    assert "+0 %" not in drawn
