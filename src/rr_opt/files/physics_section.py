"""The robot file's `physics`: effects of the catalogue with the values of their parameters."""

from types import MappingProxyType
from typing import Any

from rr_opt.effects import OF_ROBOTS
from rr_opt.effects.effect import Effect, Parameter
from rr_opt.files.issue import Issue
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import shown, unknown_word
from rr_opt.model.robot import EffectUse
from rr_opt.outcome import InputError
from rr_opt.units import Number


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
    uses: dict[str, EffectUse] = {}
    for section in sections:
        name = section.data.get("name")
        effect = OF_ROBOTS.get(name) if isinstance(name, str) else None
        if effect is None:
            known = ", ".join(OF_ROBOTS)
            message = f"Read {shown(name)}. Expected the name of an effect: {known}."
            if isinstance(name, str):
                message = unknown_word(name, list(OF_ROBOTS), "effect")
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


def _values(effect: Effect, entry: dict[str, Any]) -> tuple[dict[str, float], list[Any]]:
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


def _quantity(parameter: Parameter) -> Number:
    low, high = parameter.bounds
    unit = parameter.unit.replace("dimensionless", "")
    return Number(unit, f"{parameter.typical:g}", at_least=low, at_most=high)


def effects_json_schema() -> dict[str, Any]:
    """JSON Schema of the list of effects, one alternative for each effect of the catalogue."""
    return {"type": "array", "items": {"oneOf": [_json_schema(e) for e in OF_ROBOTS.values()]}}


def _json_schema(effect: Effect) -> dict[str, Any]:
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
