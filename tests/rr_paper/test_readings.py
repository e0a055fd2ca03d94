"""A robot rebuilt for a ratio has it, under every reading."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rr_paper.consistency import READINGS, prototype
from tests.mechanics.cases import REPEATABLE, numbers

robots = st.builds(
    prototype, numbers(-0.03, 0.03), numbers(-0.03, 0.03), numbers(0.02, 0.08), numbers(0.01, 1.0)
)


@pytest.mark.parametrize("reading", READINGS, ids=lambda one: one.name)
def test_ratio(reading):
    @REPEATABLE
    @given(robots, numbers(0.14, 0.3))
    def rebuilt(robot, ratio):
        assert reading.ratio(reading.build(robot, ratio)) == pytest.approx(ratio, rel=1e-9)

    rebuilt()
