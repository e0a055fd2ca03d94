"""A run's start is judged by what it really leaves."""

from types import SimpleNamespace

import numpy as np
import pytest

from rr_opt.sysid import evaluation as level
from rr_opt.sysid.model import Piece

PIECE = Piece(0, 0, 10)


@pytest.mark.parametrize("first", [900.0, np.inf])
def test_a_start_that_only_promises_little_is_not_enough(monkeypatch, first):
    poor, good = np.array([0.0]), np.array([1.0])
    left = {0.0: first, 1.0: 5.0}
    problem = SimpleNamespace(
        model=SimpleNamespace(
            start=lambda piece: good,
            runs=[SimpleNamespace(values=np.zeros((10, 1)), t=np.arange(10.0))],
            window=20.0,
        ),
        costs=lambda values, starts: {p: left[float(start[0])] for p, start in starts.items()},
    )
    promising = SimpleNamespace(cost=0.0)
    monkeypatch.setattr(
        level,
        "_started",
        lambda _, starts: SimpleNamespace(starts=starts, normals=dict.fromkeys(starts, promising)),
    )
    assert level._best_starts(problem, {PIECE: poor}) == {PIECE: good}
