"""What a diagnosis said, as far as it is scored."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

_FIT = ("heldout_rms_before", "heldout_rms_parameters", "heldout_rms_after")


@dataclass(frozen=True)
class Named:
    """An effect or a parameter that was named; intervals: 95 %, by parameter, SI."""

    name: str
    confidence: float
    intervals: Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class Claim:
    """verdict    consistent, parameters, missing_physics or unexplained
    named       strongest first
    groups      names that the recordings cannot tell apart
    before, refitted, after  held-out misfit, RMS in sigma, 1 is the noise: as believed, with the
                parameters alone, with all that was found; None where it was not told
    p_values    by the test's name
    """

    verdict: str
    named: tuple[Named, ...] = ()
    groups: tuple[frozenset[str], ...] = ()
    before: float | None = None
    refitted: float | None = None
    after: float | None = None
    p_values: Mapping[str, float] | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """All names, strongest first."""
        return tuple(one.name for one in self.named)


def claim_record(diagnosis: Mapping[str, Any]) -> dict[str, Any]:
    """What is scored of a `diagnosis.json`, as plain data.

    Raises KeyError, TypeError or AttributeError if it is not one.
    """
    return {
        "verdict": str(diagnosis["verdict"]),
        "effects": [
            {
                "name": str(one["name"]),
                "confidence": one["confidence"],
                "parameters": {
                    name: {"value": each["value"], "ci95": list(each["ci95"])}
                    for name, each in one["parameters"].items()
                },
            }
            for one in diagnosis["effects"]
        ],
        "indistinguishable": [list(group) for group in diagnosis["indistinguishable"]],
        "fit": {name: diagnosis["fit"].get(name) for name in _FIT},
        "p_values": {"any mismatch": diagnosis["mismatch"]["p_value"]}
        | {one["test"]: one["p_value"] for one in diagnosis["location"].get("evidence", [])},
    }


def claim_from(record: Mapping[str, Any]) -> Claim:
    """The claim of such a record; an interval without both ends is left out."""
    before, refitted, after = (record["fit"][name] for name in _FIT)
    return Claim(
        record["verdict"],
        tuple(_named(one) for one in record["effects"]),
        tuple(frozenset(group) for group in record["indistinguishable"]),
        before,
        refitted,
        after,
        {test: p for test, p in record["p_values"].items() if p is not None},
    )


def _named(one: Mapping[str, Any]) -> Named:
    ends = {name: each["ci95"] for name, each in one["parameters"].items()}
    intervals = {name: (low, high) for name, (low, high) in ends.items() if None not in (low, high)}
    return Named(one["name"], one["confidence"] or 0.0, intervals)
