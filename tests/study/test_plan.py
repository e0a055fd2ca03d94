"""Every case that is not solved cold lies between anchors, beside one along every ordered axis."""

import itertools

import pytest

from rr_opt.design.study.plan import plan

SHAPES = [(1,), (2,), (3,), (4,), (11,), (13, 9), (5, 1, 7), (2, 2)]


def ordered(shape):
    return [[10.0 * step for step in range(n)] for n in shape]


@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_each_case_is_an_anchor_or_has_donors_that_are(shape):
    made = plan(ordered(shape), shape)
    cases = set(range(len(list(itertools.product(*map(range, shape))))))
    assert set(made.anchors) | set(made.donors) == cases
    assert not set(made.anchors) & set(made.donors)
    for donors in made.donors.values():
        assert {case for case, _ in donors} <= set(made.anchors)
        assert sum(weight for _, weight in donors) == pytest.approx(1)
        assert all(weight >= 0 for _, weight in donors)


@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_an_anchor_is_next_to_it_along_every_axis(shape):
    made = plan(ordered(shape), shape)
    steps = list(itertools.product(*map(range, shape)))
    for case, donors in made.donors.items():
        apart = [
            max(abs(a - b) for a, b in zip(steps[case], steps[donor], strict=True))
            for donor, _ in donors
        ]
        assert min(apart) == 1


def test_weights_place_the_case_among_its_donors():
    numbers = [5.0, 6.0, 7.5, 9.0, 2.0]  # not in order, and unevenly spaced
    made = plan([[n - 20 for n in numbers]], [5])
    assert made.donors
    for case, donors in made.donors.items():
        assert sum(weight * numbers[donor] for donor, weight in donors) == pytest.approx(
            numbers[case]
        )


def test_words_have_no_neighbours():
    made = plan([None, [1.0, 2.0, 3.0, 4.0]], [2, 4])
    assert all(donor // 4 == case // 4 for case, of in made.donors.items() for donor, _ in of)
    assert all(one // 4 == other // 4 for one, other in made.adjacent)


def test_adjacent_cases_are_one_step_apart_in_value():
    made = plan([[30.0, 10.0, 20.0]], [3])
    assert {frozenset(pair) for pair in made.adjacent} == {frozenset((1, 2)), frozenset((2, 0))}
