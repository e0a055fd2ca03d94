"""A study file is every combination of its values, each read as a problem file would be."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.files.lint import schema
from rr_opt.files.problem_file import read_problem
from rr_opt.files.study_file import read_study


@pytest.fixture
def study(write):
    return lambda text: read_study(write(text, "study.yaml"))[0]


def values(made, key):
    return [made.inputs(case)[key] for case in range(len(made.problems))]


def test_product_the_last_key_fastest(study):
    made = study("vary: {limits.torque: [1, 2], limits.rate: [3 rpm, 6 rpm, 9 rpm]}\n")
    assert made.shape == (2, 3)
    assert [p.limits.torque for p in made.problems] == [1, 1, 1, 2, 2, 2]
    rates = [p.limits.rate * 30 / math.pi for p in made.problems]
    assert rates == pytest.approx([3, 6, 9] * 2)
    assert values(made, "limits.rate") == [p.limits.rate for p in made.problems]


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        ("{from: 1, to: 3, count: 5}", [1, 1.5, 2, 2.5, 3]),
        ("{from: 100 mN*m, to: 0.4, step: 0.1}", [0.1, 0.2, 0.3, 0.4]),
        ("{from: 3, to: 1, step: -1}", [3, 2, 1]),
        ("{from: 0.01, to: 1, count: 3, spacing: log}", [0.01, 0.1, 1]),
        ("{from: 1, to: 2, step: 0.4}", [1, 1.4, 1.8]),
    ],
)
def test_ranges(study, written, expected):
    made = study(f"vary: {{limits.torque: {written}}}\n")
    assert [p.limits.torque for p in made.problems] == pytest.approx(expected)


def test_together_is_in_step(study):
    made = study(
        "together:\n- {robot.platform1.kappa: [1e-5, 2e-5], robot.platform2.kappa: [3e-5, 4e-5]}\n"
    )
    kappas = [(p.robot.platform1.kappa, p.robot.platform2.kappa) for p in made.problems]
    assert kappas == [(1e-5, 3e-5), (2e-5, 4e-5)]


def test_a_case_is_the_problem_with_the_value_written_in_it(study, write):
    made = study(
        "problem: {gait: {period: [0.4, 2.0]}, direction: forward}\n"
        "vary: {'gait.period[1]': [1.5 s], robot.servo.torque_limit: [0.5], inertia_ratio: "
        "[[0.1, 0.2]]}\n"
    )
    robot = write(
        "platform1: {m: 0.469, I: 0.00386, c: 186 mm, a: 0.0, b: 22 mm, kappa: 6.2e-5}\n"
        "platform2: {m: 0.250, I: 0.00175, c: 44.1 mm, a: 0.0, b: 22 mm, kappa: 6.2e-5}\n"
        "h: 20 mm\nservo: {torque_limit: 0.5}\n",
        "robot.yaml",
    )
    single = write(
        f"robot: {robot.name}\ngait: {{period: [0.4, 1.5]}}\ndirection: forward\n"
        "inertia_ratio: [0.1, 0.2]\n",
        "problem.yaml",
    )
    (case,), alone = made.problems, read_problem(single)
    assert case.gait == alone.gait
    assert case.limits == alone.limits
    assert case.inertia_ratio == alone.inertia_ratio
    assert case.robot.servo == alone.robot.servo
    assert case.robot.platform1 == alone.robot.platform1


def test_robots_by_file_and_effects_by_list(study, write, robot_text):
    write(robot_text, "one.yaml")
    write(robot_text.replace("m: 0.469", "m: 0.5"), "two.yaml")
    made = study(
        "vary:\n  robot: [one.yaml, two.yaml]\n"
        "  robot.physics: [[], [{name: coulomb_friction, force1: 0.02, force2: 0.02}]]\n"
    )
    assert [p.robot.platform1.m for p in made.problems] == [0.469, 0.469, 0.5, 0.5]
    assert [len(p.robot.physics) for p in made.problems] == [0, 1, 0, 1]


def test_every_mistake_at_once(write):
    text = (
        "problem: {gait: {amplitud: 3}}\n"
        "vary:\n"
        "  limits.rat: [1]\n"
        "  gait.period: {from: 1 s, to: 2 s, count: 3, step: 1}\n"
        "  limits.torque: {from: 1, to: 2, cuont: 3}\n"
        "  direction: {from: 1, to: 2, count: 3}\n"
        "together: [{robot.platform1.m: [1, 2], robot.platform2.m: [1, 2, 3]}]\n"
    )
    with pytest.raises(InvalidFileError) as caught:
        read_study(write(text, "study.yaml"))
    told = {issue.path: issue for issue in caught.value.issues}
    assert {path: issue.line for path, issue in told.items()} == {
        "problem.gait.amplitud": 1,
        "vary.'limits.rat'": 3,
        "vary.'gait.period'": 4,
        "vary.'limits.torque'.cuont": 5,
        "vary.direction": 6,
        "together[0]": 7,
    }
    assert "Did you mean `rate`?" in told["vary.'limits.rat'"].message
    assert "Did you mean `count`?" in told["vary.'limits.torque'.cuont"].message


def test_a_value_is_refused_where_it_is_written_with_its_case(write):
    text = "vary:\n  limits.rate: [10 rpm, -1 rpm, 3 kg]\n  direction: [forward, upward]\n"
    with pytest.raises(InvalidFileError) as caught:
        read_study(write(text, "study.yaml"))
    told = [(issue.path, issue.line) for issue in caught.value.issues]
    assert sorted(told) == [("vary.'limits.rate'", 2)] * 2 + [("vary.direction", 3)]
    text = str(caught.value)
    assert "In the case limits.rate = '-1 rpm', direction = 'forward', and 1 more" in text


@pytest.mark.parametrize(
    ("text", "place", "told"),
    [
        ("vary: {limits.rate: [1, 2]}\ntogether: [{}]\n", "together[0]", "an empty mapping"),
        ("vary: {limits.rate: [1, 2]}\ntogether: [3]\n", "together[0]", "Read 3."),
        ("vary: {limits: [{rate: 1}], limits.rate: [1]}\n", "vary.'limits.rate'", "`limits`"),
        ("vary: {limits.rate: [1], limits: [{rate: 1}]}\n", "vary.limits", "`limits.rate`"),
        (
            "vary: {gait.period: [[1, 2]]}\ntogether: [{'gait.period[1]': [2, 3]}]\n",
            "together[0].'gait.period[1]'",
            "`gait.period`",
        ),
        (
            "vary: {robot.servo: [{torque_limit: 1}], robot: [{h: 1}]}\n",
            "vary.robot",
            "`robot.servo`",
        ),
        ("vary: {limits.rate: [3, 4, 3.0]}\n", "vary.'limits.rate'", "value 3, which is value 1"),
        ("vary: {limits.rate: [30 rpm, 180 deg/s]}\n", "vary.'limits.rate'", "'180 deg/s'"),
        ("vary: {direction: [forward, forward]}\n", "vary.direction", "value 2"),
        (
            "vary: limits.rate = 10 .. 30 rpm\ntogether: [{limits.torque: [1, 2]}]\n",
            "vary",
            "Expected keys, each with its values",
        ),
        ("vary: [a]\ntogether: [{limits.torque: [1, 2]}]\n", "vary", "Read ['a']"),
        ("vary: {limits.torque: [1, 2]}\ntogether: 7\n", "together", "Expected a list"),
        (
            "together: [{limits.rate: [1, 1, 1], limits.torque: [1, 2, 1]}]\n",
            "together[0]",
            "value 3, which is value 1",
        ),
    ],
)
def test_what_is_asked_for_twice_or_not_at_all_is_refused(write, text, place, told):
    with pytest.raises(InvalidFileError) as caught:
        read_study(write(text, "study.yaml"))
    messages = {issue.path: issue.message for issue in caught.value.issues}
    assert place in messages
    assert told in messages[place]


def test_values_in_step_may_be_there_again_one_by_one(study):
    made = study("together: [{limits.rate: [1, 1, 2], limits.torque: [1, 2, 2]}]\n")
    assert [(p.limits.rate, p.limits.torque) for p in made.problems] == [(1, 1), (1, 2), (2, 2)]


@pytest.mark.parametrize(
    ("written", "bare"),
    [
        ("{from: 10 rpm, to: 2, count: 3}", ["`to: 2`"]),
        ("{from: 1, to: 30 rpm, count: 3}", ["`from: 1`"]),
        ("{from: 10 rpm, to: 30 rpm, step: 1}", ["`step: 1`"]),
        ("{from: 10 rpm, to: 30 rpm, step: 3 rpm}", []),
        ("{from: 1, to: 2, count: 3}", []),
        ("{from: '1e0', to: 2, count: 3}", []),
    ],
)
def test_a_number_without_unit_beside_one_with_a_unit_is_doubted(write, written, bare):
    _, warnings = read_study(write(f"vary: {{limits.rate: {written}}}\n", "study.yaml"))
    doubts = [one.message for one in warnings if "without a unit" in one.message]
    assert len(doubts) == len(bare)
    assert all(one in doubt and "rad/s" in doubt for one, doubt in zip(bare, doubts, strict=True))


def test_zero_needs_no_unit(write):
    text = "vary: {gait.offset[0]: {from: 0, to: 30 deg, count: 3}}\n"
    text = "problem: {gait: {offset: [0, 0.7]}}\n" + text.replace(
        "gait.offset[0]", "'gait.offset[0]'"
    )
    assert read_study(write(text, "study.yaml"))[1] == []


def test_the_schema_offers_no_default_that_it_forbids():
    def nodes(node):
        if isinstance(node, dict):
            yield node
        for below in node.values() if isinstance(node, dict) else node:
            if isinstance(below, dict | list):
                yield from nodes(below)

    counts = [node["count"] for node in nodes(schema("study")) if "count" in node]
    assert counts
    assert all(one["minimum"] == 2 and "default" not in one for one in counts)


@pytest.mark.parametrize("changed", ["study.yaml", "problem.yaml", "one.yaml", "two.yaml"])
def test_the_fingerprint_is_over_every_file(write, robot_text, changed):
    write(robot_text, "one.yaml")
    write(robot_text, "two.yaml")
    write("robot: one.yaml\n", "problem.yaml")
    path = write("problem: problem.yaml\nvary: {robot: [one.yaml, two.yaml]}\n", "study.yaml")
    before = read_study(path)[0].sha256
    with (path.parent / changed).open("a") as file:
        file.write("# a remark\n")
    assert read_study(path)[0].sha256 != before


@pytest.mark.parametrize("name", ["servo", "limits", "inertia"])
def test_the_examples_can_be_used(name):
    made, _ = read_study(Path(__file__).parents[2] / "problems" / "studies" / f"{name}.yaml")
    assert len(made.problems) == math.prod(made.shape)
