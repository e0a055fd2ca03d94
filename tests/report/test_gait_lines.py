"""What an optimiser leaves of a coefficient that is 0 is printed as 0."""

import pytest

from rr_opt.model.gait import FourierGait
from rr_opt.results.gait import gait_facts


@pytest.mark.parametrize("scale", [1.0, -1e-3])
def test_below_a_ten_thousandth_of_the_largest(scale):
    sizes = [scale * size for size in (0.2, 1.9e-5, 2.1e-5, -4e-11)]
    sines, cosines = (0.0, *sizes[1:]), (sizes[0], 0.0, 0.0, 0.0)
    lines = [fact.value for fact in gait_facts(FourierGait(1.0, 0.0, sines, cosines))[4:]]
    assert [line.split(" rad of the sine, ")[0] == "0" for line in lines] == [
        True,
        True,
        False,
        True,
    ]
    assert "0 rad of the cosine" not in lines[0]
    assert all(line.endswith(", 0 rad of the cosine") for line in lines[1:])
