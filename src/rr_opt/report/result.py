"""result.json: the answer for scripts. All numbers are SI, and null stands for `none`."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rr_opt.answers.corrected_robot import finite, robot_record
from rr_opt.answers.speed import SpeedAnswer
from rr_opt.design.solve import Candidate
from rr_opt.files.gait_record import gait_record
from rr_opt.model.ballast import load_count
from rr_opt.version import __version__

UNITS = {
    "angle": "rad",
    "rate": "rad/s",
    "torque": "N m",
    "singularity": "m",
    "amplitude": "rad",
    "period": "s",
    "offset": "rad",
    "inertia_ratio": "1",
    "speed": "m/s",
    "speed_as_built": "m/s, of the fastest gait of the robot with its inertia ratio unchanged",
    "dx": "m",
    "dy": "m",
    "dpsi": "rad",
    "radius": "m",
    "shadow_price": "m/s of |speed| per SI unit by which the limit or bound is raised",
    "gap": "(|speed| - |sweep_best|)/|speed|",
    "sweep_error": "|speed by the sweep's model - speed|/|speed|",
    "replay_error": "|replay speed - speed|/|speed|",
    "limit_excess": "largest (value - limit)/limit over the replayed cycle",
}


def result(answer: SpeedAnswer) -> dict[str, Any]:
    """The content of result.json; the same keys whatever the outcome."""
    optimum, best = answer.optimum, answer.optimum.best
    record: dict[str, Any] = {
        "status": answer.status.value,
        "message": answer.message,
        "warnings": list(answer.warnings),
        "problem": answer.name,
        "gait": gait_record(best.gait) if best else None,
        "inertia_ratio": optimum.ratio,
        "speed": best.speed if best else None,
        "speed_as_built": answer.as_built,
        "cycle": _cycle(answer),
        "limits": _limits(answer),
        "bounds": _bounds(answer),
        "check": _check(answer),
        "solver": {
            "starts": optimum.starts,
            "iterations": optimum.iterations,
            "intervals": optimum.intervals,
            "distinct_optima": [_optimum(answer, one) for one in optimum.optima],
            "ties": len(optimum.ties),
            "failures": list(optimum.failures),
        },
        "robot": robot_record(optimum.robot or optimum.problem.robot),
        "loads": _loads(answer),
        "units": UNITS,
        "version": __version__,
        "input_sha256": answer.sha256,
    }
    return record


def _cycle(answer: SpeedAnswer) -> dict[str, Any] | None:
    if answer.replay is None:
        return None
    cycle = answer.replay.steady.cycle
    return {
        "dx": cycle.dx,
        "dy": cycle.dy,
        "dpsi": cycle.dpsi,
        "radius": cycle.radius if turns(answer) else None,
    }


def turns(answer: SpeedAnswer) -> bool:
    """Whether the robot goes round a circle: a radius of many kilometres is a straight line."""
    return answer.replay is not None and abs(answer.replay.steady.cycle.dpsi) > 1e-7


def _limits(answer: SpeedAnswer) -> list[dict[str, Any]]:
    return [
        {
            "name": row.name,
            "value": finite(row.value),
            "limit": finite(row.limit),
            "unit": UNITS[row.name],
            "active": row.active if answer.replay else None,
            "shadow_price": finite(row.shadow_price),
        }
        for row in answer.limits.values()
    ]


def _bounds(answer: SpeedAnswer) -> list[dict[str, Any]]:
    return [asdict(row) for row in answer.bounds.values()]


def _check(answer: SpeedAnswer) -> dict[str, Any] | None:
    replay, sweep = answer.replay, answer.sweep
    if replay is None or sweep is None:
        return None
    return {
        "sweep_points": sweep.points,
        "sweep_best": finite(sweep.best_speed),
        "sweep_gait": gait_record(sweep.best_gait) if sweep.best_gait else None,
        "gap": finite(sweep.gap),
        "sweep_error": finite(sweep.error),
        "replay_error": finite(replay.error),
        "replay_speed": replay.speed,
        "limit_excess": finite(replay.excess),
    }


def _optimum(answer: SpeedAnswer, one: Candidate) -> dict[str, Any]:
    return {
        "speed": one.speed,
        "gait": gait_record(one.gait),
        "inertia_ratio": answer.ratio_of(one),
    }


def _loads(answer: SpeedAnswer) -> float | None:
    """How many loads the robot carries, where loads realise the inertia ratio."""
    optimum, choice = answer.optimum, answer.optimum.problem.inertia_ratio
    if choice is None or choice.by != "loads" or optimum.ratio is None:
        return None
    count = load_count(optimum.problem.robot, optimum.ratio, choice.about, choice.loads)
    return round(count) if choice.loads.whole else count
