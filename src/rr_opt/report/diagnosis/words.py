"""How findings are written for people: names, verdicts, values with their intervals."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from rr_opt.formatting import number
from rr_opt.model.parameters import PARAMETERS
from rr_opt.sysid.diagnosis import Diagnosis, Estimate, Finding, Remainder, Stage
from rr_opt.sysid.settings import SETTINGS

_NAMES = {
    "coulomb_friction": "Coulomb friction",
    "left_right_drag": "drag that differs between left and right",
    "com_offset": "an off-axis centre of mass",
    "axle_misalignment": "an axle misalignment",
    "marker_offset": "an offset of the tracked point",
    "clock_offset": "a clock offset",
    "floor_tilt": "a floor tilt",
    "floor_patch": "a floor patch",
    "lateral_slip": "lateral slip of the wheels",
    "servo_lag": "servo lag",
    "servo_rate_limit": "the servo's rate limit",
    "servo_backlash": "servo backlash",
    "servo_offset": "a servo offset",
    "wheel_inertia": "wheel inertia",
}

_COMMON = {
    "m": ("mm", 1e3, 1.0),
    "kg": ("g", 1e3, 1.0),
    "s": ("ms", 1e3, 1.0),
    "N": ("mN", 1e3, 1.0),
    "rad": ("mrad", 1e3, 0.5),
    "N m s": ("µN m s", 1e6, 1e-2),
    "kg m^2": ("kg m²", 1.0, math.inf),
    "dimensionless": ("", 1.0, math.inf),
}
"""SI unit to the one that people think in, and below what size they do."""


def effect_words(name: str) -> str:
    """An effect in words, as the object of a sentence."""
    return _NAMES.get(name, name.replace("_", " "))


def parameter_words(name: str) -> str:
    """`kappa1` as `viscous wheel friction of platform 1`; anything else as it is."""
    return PARAMETERS[name].full_words if name in PARAMETERS else name.replace("_", " ")


def candidate_words(effects: Sequence[str]) -> str:
    """A set of effects."""
    names = (one.replace("_", " ").replace("coulomb", "Coulomb") for one in effects)
    return " + ".join(names) or "none (parameters only)"


def listed(words: Iterable[str]) -> str:
    """`one`, `one and two`, `one, two and three`."""
    several = list(words)
    return " and ".join([", ".join(several[:-1]), several[-1]] if several[1:] else several)


def headline(found: Diagnosis) -> str:
    """The verdict in a sentence."""
    names = [one.name for one in found.findings]
    if found.verdict == "consistent":
        return "The model explains the recordings"
    if found.verdict == "parameters":
        several = len(names) > 1
        return (
            f"The model is right, but {listed(map(parameter_words, names)) or 'a value'} "
            f"{'are' if several else 'is'} not as believed"
        )
    if found.verdict == "missing_physics":
        return f"The model leaves out {listed(map(effect_words, names)) or 'something'}"
    return "Physics is missing, and no known effect accounts for it"


def value_text(one: Estimate) -> str:
    """`15.2 mN [14.1, 16.3]`, with digits as its interval allows."""
    unit, value, ends = _people(one)
    return f"{value} {unit}".strip() + f" [{ends[0]}, {ends[1]}]"


def interval_text(one: Estimate) -> str:
    """`14.1 to 16.3 mN`."""
    unit, _, ends = _people(one)
    return f"{ends[0]} to {ends[1]} {unit}".strip()


def number_text(one: Estimate, value: float) -> str:
    """Another value of the same quantity, in its unit and with its digits."""
    unit, factor, digits = _scale(one)
    return f"{_fixed(value * factor, digits)} {unit}".strip()


def _people(one: Estimate) -> tuple[str, str, tuple[str, str]]:
    unit, factor, digits = _scale(one)
    value, low, high = (_fixed(x * factor, digits) for x in (one.value, one.low, one.high))
    return unit, value, (low, high)


def _scale(one: Estimate) -> tuple[str, float, int | None]:
    """Unit, how many of it are one SI unit, and decimals: two digits of the interval; or None."""
    finite = [abs(x) for x in (one.value, one.low, one.high) if math.isfinite(x)]
    size = max(finite, default=0.0)
    unit, factor, below = _COMMON.get(one.unit, (one.unit, 1.0, math.inf))
    if size >= below:
        unit, factor = one.unit, 1.0
    width = (one.high - one.low) * factor
    if not (math.isfinite(width) and width > 0) or not 1e-3 <= size * factor < 1e6:
        return unit, factor, None
    return unit, factor, min(max(1 - math.floor(math.log10(width / 2)), 0), 6)


def _fixed(value: float, digits: int | None) -> str:
    if not math.isfinite(value):
        return "∞" if value > 0 else "-∞"
    return number(value, 3) if digits is None else f"{value:.{digits}f}"


def total(beyond: float) -> float:
    """A misfit of which `beyond` is beyond the noise, both RMS in sigma: 1 is the noise alone."""
    return math.hypot(1.0, beyond)


def remainder_text(one: Remainder) -> str:
    """What is left: `small: misfit 1.08 σ, 3 % of the excess over the noise; a force ...`."""
    if one.size == "none":
        return "none"
    depends = f"; {one.depends_on}" if one.depends_on else ""
    share = f"{100 * one.share:.0f} % of the initial excess over the noise"
    return f"{one.size}: misfit {total(one.rms):.2f} σ, {share}{depends}"


def share_text(finding: Finding) -> str:
    """The share of the mismatch that it explains."""
    return f"{100 * finding.removes:.0f} %"


def stage_words(stages: Sequence[Stage]) -> list[str]:
    """Of each channel `fault`, where an unknown input would explain most; `affected`, where one
    would explain some of the misfit too; or `clear`."""
    return ["fault" if stage.guilty else _unlit(stage) for stage in stages]


def _unlit(stage: Stage) -> str:
    seen = stage.p_value < SETTINGS.false_alarm and stage.size > SETTINGS.negligible
    return "affected" if seen else "clear"


def stage_name(stage: Stage) -> str:
    """`rolling`, `axle 1, sideways`."""
    return _STAGES.get(stage.channel, stage.name.replace("_", " "))


_STAGES = {"constraint_axle1": "axle 1, sideways", "constraint_axle2": "axle 2, sideways"}


def stage_text(stage: Stage, found: Diagnosis) -> str:
    """What an unknown input there would explain, and the chance of it: `explains 55 %, p < 1e-12`.

    The share is of the misfit beyond the noise with the robot's values re-fitted, in mean square;
    none is given where that is negligible.
    """
    beyond, p, parts = max(found.mismatch.rms, stage.size), stage.p_value, []
    if beyond > SETTINGS.negligible:
        parts.append(f"explains {100 * (stage.size / beyond) ** 2:.0f} %")
    if p < 1e-12:
        parts.append("p < 1e-12")
    elif math.isfinite(p):
        parts.append(f"p = {p:.2f}" if p >= 0.095 else f"p = {p:.1g}")
    return ", ".join(parts)
