"""A gait, its speed and its robot as facts and tables, and the effects that the gait ignores."""

import math
from collections.abc import Iterator
from dataclasses import replace

from rr_opt.documents import document as doc
from rr_opt.effects.effect import Port
from rr_opt.formatting import QUANTITIES, direction_text, number, speed_text, with_unit
from rr_opt.messages import listed
from rr_opt.model.gait import FourierGait, FreeGait, Gait
from rr_opt.model.parameters import PARAMETERS, parameters_of
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.motion.dynamics import ignored_in_steady_cycle
from rr_opt.motion.servo import linear_servo

_NEGLIGIBLE = 1e-4
"""A smaller coefficient, relative to the largest, is 0 to within the optimiser's tolerance."""


def gait_facts(gait: Gait) -> tuple[doc.Fact, ...]:
    """Shape, amplitude, period, offset and, of a Fourier gait, the coefficients."""
    return (
        doc.Fact("gait", *_shape(gait)),
        _both("amplitude", gait.amplitude),
        doc.Fact("period", with_unit(gait.period, "s"), f"({with_unit(1 / gait.period, 'Hz')})"),
        _both("offset", gait.offset),
        *_harmonics(gait),
    )


def _shape(gait: Gait) -> tuple[str, str]:
    if isinstance(gait, FourierGait):
        return f"{gait.harmonics} harmonics", "phi(t) = offset + harmonics of the period"
    if isinstance(gait, FreeGait):
        return "free", f"phi(t) with a constant acceleration on each of {gait.pieces} intervals"
    return "sine", "phi(t) = amplitude sin(2 pi t/period) + offset"


def _both(name: str, value: float) -> doc.Fact:
    first, _, second = QUANTITIES[name].both(value).partition(" (")
    return doc.Fact(name, first, f"({second}")


def _harmonics(gait: Gait) -> Iterator[doc.Fact]:
    if not isinstance(gait, FourierGait):
        return
    least = _NEGLIGIBLE * max(map(abs, gait.sines + gait.cosines))
    for n, sizes in enumerate(zip(gait.sines, gait.cosines, strict=True), 1):
        sine, cosine = (with_unit(size if abs(size) >= least else 0, "rad") for size in sizes)
        yield doc.Fact(f"harmonic {n}", f"{sine} of the sine, {cosine} of the cosine")


def speed_fact(speed: float) -> doc.Fact:
    """A signed mean speed, and which platform leads."""
    leading = 1 if speed > 0 else 2
    return signed_fact("speed", speed, f"{direction_text(speed)}: platform {leading} leads")


def signed_fact(label: str, speed: float, detail: str) -> doc.Fact:
    """A signed speed in m/s, with mm/s and a remark as its detail."""
    value, _, other = speed_text(speed).partition(" (")
    return doc.Fact(label, value, f"({other}, {detail}" if other else detail)


def ignored_effects(robot: Robot, *, commanded: bool = False) -> tuple[str, ...]:
    """One sentence naming the robot's effects that steady motion ignores; empty if none. A rate
    limit of the servo is none of them, as gaits and drives keep it.

    commanded  gaits are the servo's commands, so its effects count
    """
    uses = [use for use in robot.physics if not math.isfinite(_rate(robot, use))]
    robot = replace(robot, physics=tuple(uses))
    names, of_servo = ignored_in_steady_cycle(robot), ignored_in_steady_cycle(robot, Port.ACTUATION)
    if commanded:
        names, of_servo = tuple(name for name in names if name not in of_servo), ()
    if not names:
        return ()
    text = (
        f"{listed(names)} {'is' if len(names) == 1 else 'are'} ignored: the motion is computed for "
        "a level, uniform floor without side "
        f"slip{'' if commanded else ' and for the angle that the servo reaches'}."
    )
    if of_servo:
        text += f" Command the servo so that it follows this angle despite {listed(of_servo)}."
    return (text,)


def _rate(robot: Robot, use: EffectUse) -> float:
    """The largest that an effect leaves the servo, rad/s."""
    return linear_servo(replace(robot, physics=(use,))).rate


_SHOWN = {"m": ("mm", 1e3), "kg m^2": ("kg m²", 1.0)}
"""SI unit -> the unit shown, and how many of it are one SI unit."""

_ORIGINS: dict[str, doc.Tone] = {"measured": "good", "fitted": "note", "assumed": "warn"}


def robot_table(robot: Robot, chosen: str) -> doc.Table:
    """Every parameter of the robot, its value, and whether it was measured, fitted or assumed.

    chosen: key path of a value that the optimiser chose.
    """
    rows = []
    for path, words, value in _parameters(robot):
        text = robot.provenance.get(path, "")
        origin = next((one for one in _ORIGINS if text.startswith(one)), "")
        badge = doc.Badge(origin or "not stated", _ORIGINS.get(origin, "quiet"))
        source = text.removeprefix(origin).lstrip(": ")
        if path == chosen:
            badge, source = doc.Badge("chosen", "note"), "by the optimiser"
        # A number stays on one line with its unit.
        rows.append([path, words, value.replace(" ", "\N{NO-BREAK SPACE}"), badge, source])
    return doc.table(["Key", "Parameter", "Value", "Origin", "Source"], rows)


def _parameters(robot: Robot) -> Iterator[tuple[str, str, str]]:
    for name, value in parameters_of(robot).items():
        parameter = PARAMETERS[name]
        unit, factor = _SHOWN.get(parameter.unit, (parameter.unit, 1.0))
        yield ".".join(parameter.key), parameter.words, with_unit(value * factor, unit)
    for name in ("angle", "rate", "torque"):
        key, kind = f"{name}_limit", QUANTITIES[name]
        yield f"servo.{key}", kind.words, kind.both(getattr(robot.servo, key))
    for use in robot.physics:
        for parameter, value in use.values.items():
            yield f"physics.{use.name}.{parameter}", "effect not in the paper", number(value)
