"""An optimum is reported as one only while every check confirms it."""

from dataclasses import replace

import pytest

from rr_opt.outcome import Status


def failed(answer, **changes):
    parts = {
        "error": lambda a, value: replace(a, replay=replace(a.replay, error=value)),
        "excess": lambda a, value: replace(a, replay=replace(a.replay, excess=value)),
        "model": lambda a, value: replace(a, sweep=replace(a.sweep, error=value)),
        "gap": lambda a, value: replace(a, sweep=replace(a.sweep, gap=value)),
    }
    for name, value in changes.items():
        answer = parts[name](answer, value)
    return answer


def test_confirmed_optimum(answer):
    assert answer.status is Status.OPTIMAL
    assert "every check confirms" in answer.message


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"error": 2e-6}, "Replay"),
        ({"excess": 2e-4}, "Limits"),
        ({"gap": -2e-4}, "Sweep"),
        ({"model": 2e-4}, "The sweep's own model"),
    ],
)
def test_a_failed_check_takes_the_verdict(answer, change, word):
    doubtful = failed(answer, **change)
    assert doubtful.status is Status.NOT_CONVERGED
    assert doubtful.status.exit_code == 4
    assert doubtful.message.startswith(f"The optimum was not confirmed. {word}")
    assert doubtful.record()["status"] == "not_converged"
    assert "FAILED" in doubtful.summary()


@pytest.mark.parametrize("change", [{"error": 5e-7}, {"excess": 5e-5}, {"gap": -5e-7}])
def test_within_the_tolerance_a_check_is_passed(answer, change):
    assert failed(answer, **change).status is Status.OPTIMAL


def test_not_a_number_is_not_a_passed_check(answer):
    assert failed(answer, gap=float("nan")).status is Status.NOT_CONVERGED


def test_ties_are_reported_as_ties(answer):
    optimum = answer.optimum
    twice = replace(optimum, optima=(*optimum.optima[:1], *optimum.optima[:1]))
    tied = replace(answer, optimum=twice)
    assert "a tie" in tied.message
    assert tied.record()["solver"]["ties"] == 1
