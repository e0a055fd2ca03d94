"""One case with its answer opened: what was hidden, what was said, and how it came out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from rr_lab.trial.lots import STRENGTHS

FLOOR = 0.1
"""Sigma of the noise, RMS: an effect that leaves less after a re-fit is invisible."""

OUTSIDE = "outside"


@dataclass(frozen=True)
class Truth:
    """kind      null, parameters, single, pair, outside or disturbed, which is null or single
    hidden     names of the effects, also of those outside the catalogue
    values     by effect or, for `parameters`, by parameter: its parameters, SI
    seen       RMS deviation of each effect alone from the nominal runs, sigma
    remains    the same after the nominal parameters are re-fitted
    spread     0: the nominal values are true; 1: off by chance
    engine     what drove the robot
    realised   by effect: which of its realisations, where it has several
    disturbance  of the recordings, by name
    """

    kind: str
    hidden: tuple[str, ...]
    values: Mapping[str, Mapping[str, float]]
    seen: Mapping[str, float]
    remains: Mapping[str, float]
    spread: float = 0.0
    engine: str = "mujoco"
    realised: Mapping[str, str] = field(default_factory=dict)
    disturbance: str = ""

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
    visible = answer["rms_deviation_from_nominal_in_sigma"]
    return Truth(
        kind=answer["kind"],
        hidden=hidden,
        values={
            one["name"]: {name: each["value"] for name, each in one["parameters"].items()}
            for one in answer["effects"]
        },
        seen={name: visible[f"visibility_{name}"] for name in hidden},
        remains={name: answer["stays_visible"][name] for name in hidden},
        spread=answer["spread"],
        engine=answer["engine"],
        realised={
            name: one["realisation"]
            for name, one in zip(hidden, answer["effects"], strict=False)
            if "realisation" in one
        },
        disturbance=answer.get("disturbance", ""),
    )


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
    groups      names that the recordings cannot distinguish
    before, refitted, after  held-out misfit, RMS in sigma, 1 is the noise: as believed, with the
                parameters alone, with all that was found; None where it is unknown
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


SURE = 0.9
"""A name with more confidence than this is named with confidence."""


@dataclass(frozen=True)
class Case:
    """What was hidden and what was said (None: no answer). wall, cpu: of the diagnosis, s."""

    id: str
    truth: Truth
    claim: Claim | None
    wall: float = 0.0
    cpu: float = 0.0
    why_none: str = ""

    @property
    def found(self) -> tuple[str, ...]:
        """The hidden names that were named, themselves or by one that the diagnosis calls
        indistinguishable from it."""
        claim = self.claim
        if claim is None:
            return ()
        return tuple(
            name for name in self.truth.names if any(_is(claim, name, s) for s in claim.names)
        )

    @property
    def extra(self) -> tuple[str, ...]:
        """Names that stand for nothing that is hidden."""
        claim = self.claim
        if claim is None:
            return ()
        hidden = self.truth.names
        return tuple(said for said in claim.names if not any(_is(claim, h, said) for h in hidden))

    @property
    def outcome(self) -> str:
        """`right`, or in some words what is wrong."""
        claim, truth = self.claim, self.truth
        if claim is None:
            return "no answer"
        if truth.kind == "null" or (truth.kind == "disturbed" and not truth.hidden):
            return "right" if claim.verdict == "consistent" else "false claim"
        if truth.kind == "parameters":
            return "right" if claim.verdict == "parameters" else f"said {claim.verdict}"
        if truth.kind == "outside":
            return _of_outside(claim)
        return self._of_named(claim)

    @property
    def scored(self) -> bool:
        """Whether it counts in the headline; invisible effects are counted separately."""
        return self.truth.visible

    @property
    def missed(self) -> bool:
        """Whether it is listed as a miss. Of what is invisible only a wrong name or none at all is
        one: that the parameters explain it is then right."""
        if self.scored:
            return self.outcome != "right"
        return self.claim is None or bool(self.claim.verdict == "missing_physics" and self.extra)

    def _of_named(self, claim: Claim) -> str:
        if claim.verdict != "missing_physics":
            return f"said {claim.verdict}"
        if len(self.found) == len(self.truth.names):
            return "right" if not self.extra else "right, and more"
        if self.found:
            return "one of two" if not self.extra else "one of two, and a wrong one"
        return "wrong name"


def _of_outside(claim: Claim) -> str:
    if any(one.confidence > SURE for one in claim.named):
        return "named with confidence"
    return "right" if claim.verdict == "unexplained" else f"said {claim.verdict}"


def _is(claim: Claim, hidden: str, said: str) -> bool:
    """Whether a name that was said stands for a hidden one."""
    return said == hidden or any({said, hidden} <= group for group in claim.groups)
