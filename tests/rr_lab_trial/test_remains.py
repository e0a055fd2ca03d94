"""Of two effects, what each leaves is told beside the other."""

from dataclasses import replace

import pytest

from rr_lab.random_case import bare_case
from rr_lab.trial.draws import _remains
from rr_opt.model.robot import EffectUse

DRAG = EffectUse("quadratic_drag", {"coefficient_total": 5.0})


def patch(beyond: float) -> EffectUse:
    """Behind an edge that stands across the robot's way."""
    values = {"multiplier": 20.0, "normal": 0.0, "edge_x": beyond, "edge_y": 0.0}
    return EffectUse("floor_patch", values)


@pytest.fixture(scope="module")
def case():
    drawn = bare_case(3, 8.0)
    plans = tuple(
        replace(plan, use="fit", periods=1, start="running", pose=(0.0, 0.0, 0.0))
        for plan in drawn.plans[1:3]
    )
    return replace(drawn, plans=plans)


def test_an_edge_that_the_robot_does_not_reach_any_more_leaves_nothing(case):
    from rr_lab.effect_size import exact_path

    ends = {}
    for name, effects in (("alone", ()), ("dragged", (DRAG,))):
        paths = [exact_path(replace(case, effects=effects), plan)[0] for plan in case.plans]
        ends[name] = max(float(path.max()) for path in paths)
    assert ends["alone"] > ends["dragged"] + 0.3
    edge = patch((ends["alone"] + ends["dragged"]) / 2)
    assert _remains(replace(case, effects=(edge,)))["floor_patch"] > 0.1
    both = _remains(replace(case, effects=(edge, DRAG)))
    assert both["floor_patch"] < 0.01
    assert both["quadratic_drag"] > 1


def test_it_is_that_of_the_robot_as_it_is(case):
    """A heavier one slides where the nominal one would not, and the other way round."""
    from rr_opt.model.parameters import parameters_of, with_parameters

    slip = EffectUse("lateral_slip/sliding", {"mu": 0.3})
    lighter = {name: 0.6 * parameters_of(case.robot)[name] for name in ("m1", "m2", "I1", "I2")}
    other = replace(case, nominal=with_parameters(case.robot, lighter), effects=(slip,))
    own = _remains(replace(case, effects=(slip,)))
    assert _remains(other) == own
