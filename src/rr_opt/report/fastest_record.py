"""result.json: a fastest gait for scripts. All numbers are SI, and null stands for `none`."""

from __future__ import annotations

from typing import Any

from rr_opt.files.record import plain, robot_record
from rr_opt.model.ballast import load_count
from rr_opt.results.fastest import FastestGait

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


def fastest_record(result: FastestGait) -> dict[str, Any]:
    """The content of result.json; the same keys whatever the outcome."""
    optimum, replay, sweep = result.optimum, result.replay, result.sweep
    cycle, driven = result.cycle, result.driven
    return {
        "status": result.status,
        "message": result.message,
        "warnings": result.warnings,
        "problem": result.name,
        "gait": result.gait,
        "joint": result.joint,
        "inertia_ratio": result.inertia_ratio,
        "speed": result.speed,
        "speed_as_built": result.as_built,
        "cycle": cycle
        and {
            "dx": cycle.dx,
            "dy": cycle.dy,
            "dpsi": cycle.dpsi,
            "radius": cycle.radius if result.turns else None,
        },
        "limits": [
            {**plain(row), "unit": UNITS[row.name], "active": row.active if replay else None}
            for row in result.limits.values()
        ],
        "bounds": list(result.bounds.values()),
        "check": replay
        and sweep
        and {
            "sweep_points": sweep.points,
            "sweep_best": sweep.best_speed,
            "sweep_gait": sweep.best_gait,
            "gap": sweep.gap,
            "sweep_error": sweep.error,
            "replay_error": replay.error,
            "replay_speed": replay.speed,
            "limit_excess": replay.excess,
        },
        "driven": driven
        and {
            "effects": driven.driven.effects,
            "beyond_optimiser": driven.beyond,
            "left_out": driven.driven.left_out,
            "speeds": driven.driven.speeds,
            "speed_without": optimum.best and optimum.best.speed,
        },
        "solver": {
            "starts": optimum.starts,
            "iterations": optimum.iterations,
            "intervals": optimum.intervals,
            "distinct_optima": [
                {
                    "speed": one.speed,
                    "gait": result.told(one.gait),
                    "inertia_ratio": result.ratio_of(one),
                }
                for one in optimum.optima
            ],
            "ties": len(optimum.ties),
            "failures": optimum.failures,
        },
        "robot": robot_record(result.robot),
        "loads": _loads(result),
        "units": UNITS,
    }


def _loads(result: FastestGait) -> float | None:
    """How many loads the robot carries, where loads realise the inertia ratio."""
    choice, ratio = result.problem.inertia_ratio, result.inertia_ratio
    if choice is None or choice.by != "loads" or ratio is None:
        return None
    count = load_count(result.problem.robot, ratio, choice.about, choice.loads)
    return round(count) if choice.loads.whole else count
