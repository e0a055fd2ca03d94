"""What is kept of a piece is never given for another start of it."""

import numpy as np

from rr_opt.sysid.model import Asked, Piece
from tests.sysid.made_up import with_effect


def test_one_piece_from_two_starts():
    model = with_effect({}, ())
    piece = Piece(0, 0, 100)
    start = model.start(piece)
    each = [Asked(piece, model.nominal, start + k * np.eye(start.size)[0]) for k in (0.0, 0.1)]
    alone = [model.off([one], ())[0] for one in each]
    for mine, other in zip(model.off(each, ()), alone, strict=True):
        np.testing.assert_array_equal(mine, other)
    assert np.abs(alone[1] - alone[0]).max() > 1


def test_how_a_drive_changes_follows_its_values():
    effects, wanted = ("servo_backlash",), ("kappa1", "servo_backlash.width")
    model = with_effect({}, ())
    piece = Piece(0, 0, 100)

    def slopes(width):
        given = {**model.nominal, "servo_backlash.width": width}
        found = model.simulated.drive_slopes(piece, given, effects, wanted)
        assert found is not None
        return found

    narrow, wide = slopes(0.01), slopes(0.04)
    assert np.abs(wide.at - narrow.at).max() > 1e-3
    np.testing.assert_array_equal(slopes(0.01).at, narrow.at)
    assert slopes(0.01) is slopes(0.01)
