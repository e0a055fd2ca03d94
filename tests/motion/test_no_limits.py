"""Where nothing is limited, nothing is broken."""

import math

from rr_opt.model.problem import Limits


def test_no_limit_is_the_worst():
    assert Limits().worst({"grip": 1.0}) == ("", -math.inf)
