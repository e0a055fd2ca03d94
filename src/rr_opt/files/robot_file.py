"""From a robot file, or the robot inside another file, to a `Robot`."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import ConfigDict, Field, GetJsonSchemaHandler, SkipValidation
from pydantic_core import CoreSchema

from rr_opt.files.fields import FileModel, Key, Keys, keys_of, validate
from rr_opt.files.issue import Issue, has_errors, required
from rr_opt.files.source import read_document
from rr_opt.files.yaml_text import FileData, KeyPath, path_text
from rr_opt.messages import shown, unknown_word
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.parameters import SYMBOLS
from rr_opt.model.robot import EffectUse, Platform, Robot, Servo
from rr_opt.outcome import InputError
from rr_opt.units import Number

if TYPE_CHECKING:
    from rr_opt.effects.effect import Effect, Parameter

_LARGEST_LENGTH = 5.0
"""Longer platforms, m, are assumed to be millimetres written as metres."""

_DENSITY = 8000.0
"""Density of steel, kg/m3."""

_LARGEST_FRICTION = 1000.0
"""With more, a robot of a kilogram stops within a fraction of a millisecond, N s/m per wheel."""


def doubts(robot: Robot) -> Iterator[tuple[tuple[str, ...], str]]:
    """Key path and message of every value that looks like a typing mistake."""
    for key, platform in (("platform1", robot.platform1), ("platform2", robot.platform2)):
        for name, message in _platform_doubts(platform):
            yield (key, name), message
    longest = max(_longest(robot.platform1)[1], _longest(robot.platform2)[1])
    if robot.h > longest:
        yield (
            ("h",),
            f"The wheel radius is {robot.h:.4g} m, larger than any length of the platforms. Plain "
            f"numbers are metres: write `{robot.h:g} mm` for millimetres.",
        )
    ratio = inertia_ratio(robot, "joint")
    if not 0.01 <= ratio <= 100:
        yield (
            ("platform2", "I"),
            f"The inertia ratio J20/J10 about the joint is {ratio:.3g}. Expected 0.01 to 100: the "
            "platforms hardly match. Check the units of m, I, c and a of both.",
        )


def singular_posture(robot: Robot) -> str | None:
    """A message if the servo can reach the posture where S1 = c1 cos phi + c2 vanishes."""
    limit, singular = robot.servo.angle_limit, robot.singular_angle
    if singular >= limit:
        return None
    return (
        f"The servo's range, {limit:.4g} rad, includes the singular posture |phi| = arccos(-c2/c1) "
        f"= {singular:.4g} rad, where a model without side slip is meaningless. A problem stays "
        "clear of it with `limits.singularity`."
    )


def _platform_doubts(platform: Platform) -> Iterator[tuple[str, str]]:
    key, longest = _longest(platform)
    gyration = math.sqrt(platform.I / platform.m)
    if platform.a > platform.c:
        yield (
            "a",
            f"a = {platform.a:.4g} m puts the centre of mass beyond the joint (c = "
            f"{platform.c:.4g} m). a is measured from the axle towards the joint; check that it is "
            "not the distance from the joint.",
        )
    if longest > _LARGEST_LENGTH:
        yield (
            key,
            f"The platform is {longest:.4g} m long. Plain numbers are metres: write "
            f"`{longest:g} mm` for millimetres.",
        )
    if platform.m / longest / longest / longest > _DENSITY:
        yield (
            "m",
            f"The platform weighs {platform.m:.4g} kg, more than a cube of steel of its "
            f"largest length, {longest:.3g} m. Plain numbers are kilograms: write "
            f"`{platform.m:g} g` for grams.",
        )
    if gyration > 3 * longest:
        yield (
            "I",
            f"The radius of gyration sqrt(I/m) is {gyration:.3g} m, more than three times the "
            f"platform's largest length, {longest:.3g} m. Check the "
            "units of I (kg m2), m, c and b.",
        )


def _longest(platform: Platform) -> tuple[str, float]:
    """The largest of its lengths, and its key."""
    lengths = {"c": platform.c, "a": abs(platform.a), "b": platform.b}
    key = max(lengths, key=lambda name: lengths[name])
    return key, lengths[key]


DEFAULT_WHEEL_RADIUS = 0.020
"""h where a robot file does not need one, m."""


class PlatformModel(keys_of(Platform)):
    """One platform with its wheel pair. Give kappa or k, not both."""

    model_config = ConfigDict(
        json_schema_extra={"oneOf": [{"required": ["kappa"]}, {"required": ["k"]}]}
    )

    kappa: Annotated[float | None, Key(SYMBOLS["kappa"].quantity)] = Field(
        default=None, description=SYMBOLS["kappa"].description
    )
    k: Annotated[float | None, Key(Number("N s/m", "0.155", at_least=0))] = Field(
        default=None, description="Viscous friction of one wheel along the floor, kappa/h^2, N s/m."
    )


class _EffectsSchema:
    """The JSON schema of `physics`, from the catalogue of effects."""

    def __get_pydantic_json_schema__(
        self, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {"type": "array", "items": {"oneOf": [*map(_effect_schema, _catalogue().values())]}}


class RobotModel(FileModel):
    """A Roller Racer. Plain numbers are SI; a text may carry a unit, such as 186 mm."""

    name: str = Field(default="", description="The robot's name.")
    platform1: PlatformModel = Field(description="The platform whose heading is psi.")
    platform2: PlatformModel = Field(description="The platform that the servo turns by phi.")
    h: Annotated[float | None, Key(SYMBOLS["h"].quantity)] = Field(
        default=None,
        description="Wheel radius, m. Needed with kappa or physics; else 20 mm, without effect.",
    )
    servo: Annotated[Servo, Keys()] = Field(
        default_factory=Servo, description="The servo's limits."
    )
    physics: Annotated[list[dict[str, Any]], SkipValidation, _EffectsSchema()] = Field(
        default_factory=list, description="Effects beyond the paper's model, by catalogue name."
    )
    provenance: Annotated[dict[str, Any], SkipValidation] = Field(
        default_factory=dict,
        description="Where values come from: the robot's keys again, each with a text that begins "
        "with measured, fitted or assumed.",
    )


ORIGINS = ("measured", "fitted", "assumed")

_KEYS: dict[str, tuple[str, ...]] = {
    "": tuple(key for key in RobotModel.model_fields if key not in ("name", "provenance")),
    "platform1": tuple(PlatformModel.model_fields),
    "platform2": tuple(PlatformModel.model_fields),
    "servo": tuple(keys_of(Servo).model_fields),
}


def read_provenance(document: FileData) -> tuple[Mapping[str, str], list[Issue]]:
    """Key path -> the sentence on where the value comes from.

    A friction given as `k` is reported under `kappa`, the robot's own name for it.
    """
    found: dict[str, str] = {}
    issues: list[Issue] = []

    def walk(value: Any, path: KeyPath) -> None:
        here = ("provenance", *path)
        if isinstance(value, dict):
            known = _KEYS.get(path_text(path))
            for key, inner in value.items():
                if known is not None and key not in known:
                    message = unknown_word(key, known, "key")
                    issues.append(document.error((*here, key), message))
                else:
                    walk(inner, (*path, key))
        elif not path or not isinstance(value, str) or not value.startswith(ORIGINS):
            message = (
                f"Read {shown(value)}. Expected a text that begins with {', '.join(ORIGINS)}. "
                "Write for example `measured: Table 1`, in quotes."
            )
            issues.append(document.error(here, message))
        else:
            kept = (*path[:-1], "kappa") if path[-1] == "k" else path
            found[path_text(kept)] = value

    walk(document.data["provenance"], ())
    return MappingProxyType(found), issues


def read_robot(path: str | Path) -> Robot:
    """The robot of a file. Raises InvalidFileError with everything that is wrong in it."""
    return required(*robot_from(read_document(Path(path))))


def robot_from(document: FileData) -> tuple[Robot | None, list[Issue]]:
    """The robot that a mapping describes (None if an issue is an error), and all issues."""
    model, issues = validate(RobotModel, document)
    issues += _friction_and_radius(document)
    beyond: dict[str, Any] = {}
    if "physics" in document.data:
        beyond["physics"], found = read_effects(document)
        issues += found
    if "provenance" in document.data:
        beyond["provenance"], found = read_provenance(document)
        issues += found
    if model is None or has_errors(issues):
        return None, issues
    h = model.h or DEFAULT_WHEEL_RADIUS
    robot = Robot(
        platform1=_platform(model.platform1, h),
        platform2=_platform(model.platform2, h),
        h=h,
        servo=model.servo,
        name=model.name,
        **beyond,
    )
    issues += [document.warning(path, message) for path, message in doubts(robot)]
    for key, k in (("platform1", robot.k1), ("platform2", robot.k2)):
        if k > _LARGEST_FRICTION:
            message = (
                f"The friction along the floor is k = kappa/h^2 = {k:.3g} N s/m per wheel. "
                f"Expected at most {_LARGEST_FRICTION:.4g}: nothing would roll. Check the "
                "units of kappa and h."
            )
            issues.append(document.error((key, "kappa"), message))
    return (None if has_errors(issues) else robot), issues


def _platform(model: PlatformModel, h: float) -> Platform:
    kappa = (model.kappa or 0.0) if model.k is None else model.k * (h * h)
    return Platform(m=model.m, I=model.I, c=model.c, a=model.a, b=model.b, kappa=kappa)


def _friction_and_radius(document: FileData) -> list[Issue]:
    """Exactly one of kappa and k for each platform, and h where its value matters."""
    issues: list[Issue] = []
    reasons = ["`physics`"] if document.data.get("physics") else []
    for key in ("platform1", "platform2"):
        platform = document.data.get(key)
        if not isinstance(platform, dict):
            continue
        if "kappa" in platform and "k" in platform:
            message = "Both kappa and k are given, and k = kappa/h^2. Keep one of them."
            issues.append(document.error((key, "k"), message))
        elif "kappa" not in platform and "k" not in platform:
            message = (
                "The wheel friction is missing. Expected kappa (N m s) or k = kappa/h^2 (N s/m). "
                "Add one of them."
            )
            issues.append(document.error((key, "kappa"), message))
        if "kappa" in platform:
            reasons.append(f"{key}.kappa")
    if reasons and "h" not in document.data:
        message = (
            f"The wheel radius (m) is missing. {reasons[0]} needs it. Add for example h: 20 mm."
        )
        issues.append(document.error(("h",), message))
    return issues


def _catalogue() -> Mapping[str, "Effect"]:
    """The effects that a robot file may name; imported here, as they load CasADi."""
    from rr_opt.effects import OF_ROBOTS

    return OF_ROBOTS


def read_effects(document: FileData) -> tuple[tuple[EffectUse, ...], list[Issue]]:
    """The effects under `physics` of a robot; a parameter that is not given is neutral."""
    if document.data["physics"] == []:
        return (), []
    sections, issues = document.entries(
        "physics",
        "a list of effects, each with a name and its parameters. Write for example "
        "`- {name: coulomb_friction, F1: 0.02, F2: 0.02}`",
        "{name: ..., and its parameters}",
    )
    catalogue, uses = _catalogue(), dict[str, EffectUse]()
    for section in sections:
        name = section.data.get("name")
        effect = catalogue.get(name) if isinstance(name, str) else None
        if effect is None:
            known = ", ".join(catalogue)
            message = f"Read {shown(name)}. Expected the name of an effect: {known}."
            if isinstance(name, str):
                message = unknown_word(name, list(catalogue), "effect")
            issues.append(section.error(("name",), message))
            continue
        if effect.name in uses:
            message = f"Read `{name}` a second time. Keep one, with all parameters."
            issues.append(section.error(("name",), message))
            continue
        values, wrong = _values(effect, section.data)
        issues += [section.error((key,), message) for key, message in wrong]
        uses[effect.name] = EffectUse(effect.name, MappingProxyType(values))
        if not wrong and len(section.data) == 1:
            keys = ", ".join(q.name for q in effect.parameters)
            message = f"No parameter is given, so it does nothing. Add {keys}."
            issues.append(section.warning((), message))
    return tuple(uses.values()), issues


def _values(effect: "Effect", entry: dict[str, Any]) -> tuple[dict[str, float], list[Any]]:
    values = {q.name: q.neutral for q in effect.parameters}
    named = {key: q for q in effect.parameters for key in (q.name, *q.aliases)}
    given: dict[str, str] = {}
    wrong: list[Any] = []
    for key, value in entry.items():
        parameter = named.get(key)
        if key == "name":
            continue
        if parameter is None:
            wrong.append((key, unknown_word(key, ["name", *named], "key")))
            continue
        if parameter.name in given:
            other = given[parameter.name]
            wrong.append((key, f"`{key}` and `{other}` are the same parameter. Keep one."))
        given[parameter.name] = key
        try:
            values[parameter.name] = _quantity(parameter).read(value)
        except InputError as error:
            wrong.append((key, str(error)))
    return values, wrong


def _quantity(parameter: "Parameter") -> Number:
    low, high = parameter.bounds
    unit = parameter.unit.replace("dimensionless", "")
    return Number(unit, f"{parameter.typical:g}", at_least=low, at_most=high)


def _effect_schema(effect: "Effect") -> dict[str, Any]:
    parameters = {
        key: {
            **_quantity(parameter).json_schema(),
            "description": f"{parameter.name}, {parameter.unit or 'dimensionless'}",
        }
        for parameter in effect.parameters
        for key in (parameter.name, *parameter.aliases)
    }
    return {
        "type": "object",
        "description": effect.sentence,
        "properties": {"name": {"const": effect.name}, **parameters},
        "required": ["name"],
        "additionalProperties": False,
    }
