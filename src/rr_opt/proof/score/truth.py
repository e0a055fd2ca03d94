"""What was hidden in a case, as its opened answer tells it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rr_opt.proof.lots import STRENGTHS

FLOOR = 0.1
"""Sigma of the noise, RMS: an effect that leaves less after a re-fit is invisible."""

OUTSIDE = "outside"


@dataclass(frozen=True)
class Truth:
    """kind      null, parameters, single, pair or outside
    hidden     names of the effects, also of those outside the catalogue
    values     by effect or, for `parameters`, by parameter: its parameters, SI
    seen       RMS deviation of each effect alone from the nominal runs, sigma
    remains    the same after the nominal parameters are re-fitted
    spread     0: the nominal values are true; 1: off by chance
    engine     what drove the robot
    """

    kind: str
    hidden: tuple[str, ...]
    values: Mapping[str, Mapping[str, float]]
    seen: Mapping[str, float]
    remains: Mapping[str, float]
    spread: float = 0.0
    engine: str = "mujoco"

    @property
    def names(self) -> tuple[str, ...]:
        """What a right diagnosis names: effects of the catalogue, or wrong parameters."""
        return () if self.kind == OUTSIDE else tuple(self.values)

    @property
    def visible(self) -> bool:
        """Whether everything hidden stays visible after a re-fit."""
        return all(self.remains[name] >= FLOOR for name in self.hidden)

    @property
    def strength(self) -> str:
        """Of a single effect, by how well it is seen before a re-fit; empty otherwise."""
        if self.kind != "single":
            return ""
        seen = self.seen[self.hidden[0]]
        return next((name for name, (_, high) in STRENGTHS.items() if seen < high), "strong")


def truth_from(answer: Mapping[str, Any]) -> Truth:
    """The truth of an opened answer."""
    hidden = tuple(answer["hidden"])
    told = answer["rms_deviation_from_nominal_in_sigma"]
    return Truth(
        kind=answer["kind"],
        hidden=hidden,
        values={
            one["name"]: {name: each["value"] for name, each in one["parameters"].items()}
            for one in answer["effects"]
        },
        seen={name: told[f"visibility_{name}"] for name in hidden},
        remains={name: answer["stays_visible"][name] for name in hidden},
        spread=answer["spread"],
        engine=answer["engine"],
    )
