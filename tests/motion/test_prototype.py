"""The shipped prototype moves at about the speeds that the paper measured on it.

Nothing here is exact: what the paper does not give is assumed, and says so in the robot file.
Its speeds are taken as magnitudes, as the paper's tables do not say which platform leads.
"""

import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.model.ballast import with_inertia_ratio
from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import steady_cycle
from tests.reference import paper


def test_table_3():
    robot = with_inertia_ratio(read_problem(None).robot, 0.3)
    inside = 0
    for row in paper.TABLE_3:
        speed = abs(steady_cycle(robot, SineGait(row.amplitude, row.period)).speed)
        assert speed == pytest.approx(row.mean, abs=2 * row.half_width)
        inside += abs(speed - row.mean) <= row.half_width
    assert inside == 4
