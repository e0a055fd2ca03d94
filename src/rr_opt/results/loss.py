"""The corrected robot of a diagnosis, and the speed that the nominal model would cost.

The nominal robot's best gait is driven, in steady motion, by the corrected robot and compared with
that robot's own best gait. Both are optimised within the limits of the robot's servo and the bounds
of the shipped problem, with the robot's inertias as they are.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

from rr_opt.effects import CATALOGUE, OF_ROBOTS
from rr_opt.effects.effect import Port
from rr_opt.files.problem_file import read_problem
from rr_opt.files.record import rounded
from rr_opt.formatting import direction_text, number, with_unit, words_of
from rr_opt.messages import listed
from rr_opt.model.experiment import Experiment
from rr_opt.model.gait import Gait
from rr_opt.model.parameters import PARAMETERS, with_parameters
from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.motion.dynamics import ignored_in_steady_cycle
from rr_opt.motion.servo import servo_made
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import RollerRacerError
from rr_opt.results.result import picked
from rr_opt.sysid.diagnosis import Diagnosis
from rr_opt.verify.sweep import check_optimum


def corrected_robot(experiment: Experiment, found: Diagnosis) -> Robot:
    """The nominal robot with re-estimated values, accepted effects, and their provenance."""
    robot = experiment.robot
    fitted = {name: rounded(value) for name, value in found.values.items()}
    # A servo no faster than observed, so that the gaits found are ones it can make.
    seen = fitted.get("servo_rate_limit.rate_limit", math.inf)
    return replace(
        with_parameters(robot, {name: v for name, v in fitted.items() if name in PARAMETERS}),
        servo=replace(robot.servo, rate_limit=min(robot.servo.rate_limit, seen)),
        physics=_physics(robot, fitted),
        provenance=MappingProxyType({**robot.provenance, **_provenance(experiment, found)}),
        name=f"{robot.name or experiment.name}, corrected",
    )


def _physics(robot: Robot, fitted: Mapping[str, float]) -> tuple[EffectUse, ...]:
    """The effects that the robot had, and those that were fitted."""
    uses = {use.name: dict(use.values) for use in robot.physics}
    for name, value in fitted.items():
        effect, dot, parameter = name.partition(".")
        if dot:
            bounds = next(q.bounds for q in OF_ROBOTS[effect].parameters if q.name == parameter)
            # Rounding may have left them.
            uses.setdefault(effect, {})[parameter] = min(max(value, bounds[0]), bounds[1])
    return tuple(EffectUse(name, MappingProxyType(values)) for name, values in uses.items())


def _provenance(experiment: Experiment, found: Diagnosis) -> dict[str, str]:
    used = sum(run.use == "fit" for run in experiment.runs)
    source = f"{used} recording{'s' if used != 1 else ''} of {experiment.name or 'an experiment'}"
    origins = {}
    for name, one in found.parameters.items():
        key = ".".join(PARAMETERS[name].key) if name in PARAMETERS else f"physics.{name}"
        if name not in PARAMETERS and "." not in name:
            continue  # a zero of the capture system, which is not the robot's
        interval = f"{one.low:.4g} to {one.high:.4g} {one.unit}".removesuffix(" dimensionless")
        origins[key] = f"fitted: {interval} (95 %), {source}"
    return origins


@dataclass(frozen=True)
class Loss:
    """The speed lost by relying on the nominal model; speeds in m/s, signed.

    believed, promised  the best gait of the nominal robot, and the speed that its model predicts
    reached             the corrected robot's speed with that gait
    best, speed         the corrected robot's own best gait; if its servo has a fault, the
                        joint angle that the servo would have to make
    unseen              whether either gait goes beyond the recorded range
    """

    believed: Gait
    promised: float
    reached: float
    best: Gait
    speed: float
    unseen: bool

    @property
    def share(self) -> float:
        """The fraction lost of the speed of its own best gait; above 1 if it drives the other
        way."""
        return 1.0 - self.reached / math.copysign(self.speed, self.promised)


@dataclass(frozen=True)
class LossUnknown:
    """Why no loss can be given, in a sentence."""

    sentence: str


def loss_of(experiment: Experiment, corrected: Robot) -> Loss | LossUnknown:
    """The loss, if steady motion can include the effects of the corrected robot.

    Takes a second or two.
    """
    # Only a robot that differs from its nominal values needs the optimiser.
    from rr_opt.design.maximize_speed import maximize_speed

    # Servo effects are accounted for here, and the capture system does not change the motion.
    harmless = (Port.ACTUATION, Port.MEASUREMENT)
    gone = [n for n in ignored_in_steady_cycle(corrected) if CATALOGUE[n].port not in harmless]
    if gone:
        return unknown(f"no steady motion can include {listed(map(words_of, gone))}.")
    try:
        before, after = (maximize_speed(_problem(one)) for one in (experiment.robot, corrected))
        if before.best is None or after.best is None or after.ratio is None:
            return unknown(next(one.message for one in (before, after) if one.best is None))
        believed, best = before.best, after.best
        if check_optimum(after.problem, best.gait, after.ratio, best.speed).better:
            return unknown("a grid sweep finds a faster gait for the corrected robot.")
        reached = steady_cycle(corrected, servo_made(corrected, believed.gait)).speed
    except RollerRacerError as error:
        return unknown(str(error))
    recorded = [run.gait for run in experiment.runs]
    unseen = any(
        one.gait.peak_angle > max(gait.peak_angle for gait in recorded)
        or one.gait.peak_rate > max(gait.peak_rate for gait in recorded)
        for one in (believed, best)
    )
    return Loss(believed.gait, believed.speed, reached, best.gait, best.speed, unseen)


def unknown(why: str) -> LossUnknown:
    """No loss, and why."""
    return LossUnknown(f"The speed lost with the nominal model's best gait is unknown: {why}")


def _problem(robot: Robot) -> Problem:
    """What `maximize-speed` solves for a robot file, with the inertias left as they are."""
    shipped, servo = read_problem(), robot.servo
    limits = Limits(
        servo.angle_limit, servo.rate_limit, servo.torque_limit, shipped.limits.singularity
    )
    return replace(shipped, robot=robot, limits=limits, inertia_ratio=None)


_NONE = 5e-4
"""A smaller share of the speed is not reported as a loss."""


def share_lost(one: Loss) -> str:
    """`12 %`; `less than 0.05 %`; `more than all` if the robot drives the other way; none if its
    own best gait, which respects the limits, is slower."""
    if one.share > 1:
        return "over 100 %"
    if one.share < -_NONE:
        return "none"
    if one.share < _NONE:
        return f"less than {100 * _NONE:g} %"
    return f"{number(100 * one.share, 2)} %"


def _why(one: Loss) -> str:
    if one.share > 1:
        return ", as it drives the robot in the opposite direction"
    return ", as it exceeds the corrected robot's limits" if one.share < -_NONE else ""


def pace(speed: float) -> str:
    """`298.3 mm/s forward`."""
    return f"{1e3 * abs(speed):.1f} mm/s {direction_text(speed)}"


def loss_sentences(one: Loss) -> str:
    """A few sentences."""
    text = (
        f"The best gait of the nominal robot ({gait_words(one.believed)}) promises "
        f"{pace(one.promised)}; the corrected robot reaches {pace(one.reached)} with it. Its own "
        f"best gait ({gait_words(one.best)}) reaches {pace(one.speed)}. Speed lost to the wrong "
        f"model: {share_lost(one)}{_why(one)}."
    )
    if one.unseen:
        text += " These gaits are more demanding than any recorded one: an extrapolation."
    return text


def loss_line(one: Loss | LossUnknown) -> str:
    """The same in a line."""
    if isinstance(one, LossUnknown):
        return one.sentence
    return (
        f"{share_lost(one)}: the nominal model's best gait promises {pace(one.promised)} and "
        f"reaches {pace(one.reached)}{_why(one)}; the corrected model's reaches {pace(one.speed)}"
    )


def gait_words(gait: Gait) -> str:
    """`1.51 rad, 1.73 s`, and an offset if there is one."""
    text = f"{with_unit(gait.amplitude, 'rad', 3)}, {with_unit(gait.period, 's', 3)}"
    return f"{text}, offset {with_unit(gait.offset, 'rad', 3)}" if gait.offset else text


def loss_record(one: Loss | LossUnknown | None) -> dict[str, Any] | None:
    """diagnosis.json's `loss`: null if the nominal robot is right; SI."""
    if one is None:
        return None
    if isinstance(one, LossUnknown):
        return {"not_told": one.sentence}
    return {
        "gait_as_believed": picked(one.believed, _SIZES),
        "speed_promised": one.promised,
        "speed_reached": one.reached,
        "gait_as_found": picked(one.best, _SIZES),
        "speed_as_found": one.speed,
        "share_lost": one.share,
        "beyond_what_was_recorded": one.unseen,
    }


_SIZES = "amplitude period offset"
