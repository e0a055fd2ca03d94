"""A fit in a wrong valley, far above the noise, ends; one that gets somewhere goes on."""

import numpy as np
import pytest

from rr_opt.sysid.least_squares import Normal, solve
from rr_opt.sysid.model import Piece, Quantity

PIECE = Piece(0, 0, 10)
FREE = Quantity("free", "", 0.0, 1.0, False, -np.inf, np.inf, 0.0)
COUNT, STEPS = 1000, 40


class Slow:
    """Every step lowers what is above the noise by the same share."""

    effects, quantities, pieces, prior = (), (FREE,), (PIECE,), np.zeros(1)

    def __init__(self, excess: float, share: float) -> None:
        self.excess, self.share, self.steps = excess, share, -1

    def cost(self, _values, _starts):
        self.steps += 1
        return COUNT + self.excess * (1 - self.share) ** self.steps, COUNT

    def normals(self, _values, starts):
        slope, ends = np.array([-1.0]), np.eye(1)
        return {piece: Normal(0.0, slope, ends, np.zeros(1), np.zeros((1, 1))) for piece in starts}

    def own(self, starts):
        return starts

    def beforehand(self, _values):
        return 0.0


@pytest.mark.parametrize(
    ("excess", "share", "given_up"),
    [
        (9 * COUNT, 0.001, True),  # far off, and all but at rest
        (9 * COUNT, 0.01, False),  # far off, and on its way
        (0.04 * COUNT, 0.001, False),  # so near the noise that little counts
    ],
)
def test_steps_that_lead_nowhere(excess, share, given_up):
    problem = Slow(excess, share)
    fit = solve(problem, {"free": 0.0}, {PIECE: np.zeros(1)}, steps=STEPS)
    assert (problem.steps < STEPS) == given_up
    assert not fit.converged
