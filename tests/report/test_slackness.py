"""An optimum short of a limit that has a price, or with a price of the wrong sign, is none."""

from dataclasses import replace

import pytest

from rr_opt.outcome import Status


def with_prices(answer, **prices):
    best = replace(answer.optimum.best, prices={**answer.optimum.best.prices, **prices})
    return replace(answer, optimum=replace(answer.optimum, best=best))


def test_an_optimum_passes(answer):
    assert any("Complementary slackness" in check.sentence for check in answer.checks)
    assert answer.status is Status.OPTIMAL


@pytest.mark.parametrize(("name", "words"), [("torque", "servo torque"), ("angle", "joint angle")])
def test_a_limit_short_of_which_the_gait_stays_has_no_price(answer, name, words):
    limit, reached = getattr(answer.problem.limits, name), answer.replay.reached[name]
    assert limit > 1.01 * reached
    priced = with_prices(answer, **{name: 1e-3 * abs(answer.speed) / (limit - reached)})
    assert priced.status is Status.NOT_CONVERGED
    assert f"limit on the {words}" in priced.message


def test_a_price_of_the_wrong_sign_is_no_price(answer):
    limit = answer.problem.limits.rate
    price = answer.optimum.best.prices["rate"]
    assert price > 0
    assert with_prices(answer, rate=-price).status is Status.NOT_CONVERGED
    assert limit == pytest.approx(answer.replay.reached["rate"], rel=1e-6)
