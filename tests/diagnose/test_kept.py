"""What is kept of a piece is never given for another start of it."""

import numpy as np

from rr_opt.diagnose.model import Asked, Piece
from tests.diagnose.made_up import with_effect


def test_one_piece_from_two_starts():
    model = with_effect({}, ())
    piece = Piece(0, 0, 100)
    start = model.start(piece)
    each = [Asked(piece, model.nominal, start + k * np.eye(start.size)[0]) for k in (0.0, 0.1)]
    alone = [model.off([one], ())[0] for one in each]
    for mine, other in zip(model.off(each, ()), alone, strict=True):
        np.testing.assert_array_equal(mine, other)
    assert np.abs(alone[1] - alone[0]).max() > 1
