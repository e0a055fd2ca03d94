"""What is hidden in a case, as the answer that a diagnosis is scored by; and its seal."""

from __future__ import annotations

import hashlib
import json
import secrets
from typing import Any

from rr_opt.lab.case import Case
from rr_opt.lab.draw.wrong_values import changed_values
from rr_opt.lab.effects import effect_named

UNITS = {"m": "kg", "I": "kg m2", "c": "m", "a": "m", "b": "m", "h": "m", "kappa": "N m s"}


def answer(case: Case) -> dict[str, Any]:
    """Verdict and effects with the values of their parameters, as plain data."""
    return {
        "verdict": case.verdict,
        "effects": _effects(case),
        "case": case.name,
        "engine": case.engine,
        "seed": case.seed,
        "rms_deviation_from_nominal_in_sigma": dict(case.notes),
    }


def _effects(case: Case) -> list[dict[str, Any]]:
    if case.verdict == "parameters":
        true = changed_values(case.robot, case.changed)
        return [
            {"name": name, "parameters": {name: _valued(value, UNITS[name.rstrip("12")])}}
            for name, value in true.items()
        ]
    found = []
    for use in case.effects:
        effect = effect_named(use.name)
        found.append(
            {
                "name": use.name if effect.named else "unknown",
                "what": effect.what if effect.named else f"{use.name}: {effect.what}",
                "parameters": {
                    name: _valued(value, effect.parameter(name).unit)
                    for name, value in use.values.items()
                },
            }
        )
    return found


def _valued(value: float, unit: str) -> dict[str, Any]:
    return {"value": float(f"{value:.9g}"), "unit": unit}


def sealed_text(case: Case) -> str:
    """The answer as JSON text, with a random word in it, so that its hash gives nothing away."""
    return json.dumps({**answer(case), "salt": secrets.token_hex(16)}, indent=2) + "\n"


def seal_of(text: str) -> str:
    """SHA-256 of a sealed answer's text, as hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()
