"""rr-opt: speed, turn and peak torque, as the sweep asks for them."""

from __future__ import annotations

from contextlib import AbstractContextManager
from unittest.mock import patch

from benchmarks.sweep.case import Array, Work
from rr_opt.verify.speeds import model_of, speeds
from rr_opt.verify.steady_fourier import SteadyFourier

NAME = "rr-opt, with a compiler"
PLAIN = "rr-opt, no compiler"


def run(work: Work, _steps: int, tolerance: float = 1e-6) -> Array:
    """|speed| (K,); NaN where it is not resolved."""
    model_of(work.problem.robot).compiled(10**6)
    return _speed(work, tolerance)


def run_plain(work: Work, _steps: int) -> Array:
    """The same as where nothing can be compiled."""
    with without_compiler():
        return _speed(work, 1e-6)


def without_compiler() -> AbstractContextManager[object]:
    """NumPy does all of it."""
    return patch.object(SteadyFourier, "compiled", lambda *_: None)


def there(work: Work) -> bool:
    """Whether something can be compiled here."""
    return model_of(work.problem.robot).compiled(10**6) is not None


def _speed(work: Work, tolerance: float) -> Array:
    """On the product grid that the points are, if they are one: the sweep has one too."""
    columns = [work.amplitude, work.period, work.offset, work.ratio]
    if work.periods > 1:
        shape = (-1, work.periods)
        columns = [column.reshape(shape) for column in columns]
        columns = [columns[0][:, :1], columns[1], columns[2][:, :1], columns[3][:, :1]]
    return abs(speeds(work.problem, *columns, tolerance).speed).ravel()
