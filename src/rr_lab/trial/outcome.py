"""One opened case: what was hidden, the diagnosis, and the outcome."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from rr_lab.trial.draws import STRENGTHS

FLOOR = 0.1
"""Sigma of the noise, RMS: an effect with a smaller residual after a re-fit is undetectable."""

SURE = 0.9
"""Confidence above which a name counts as confident."""


@dataclass(frozen=True)
class Truth:
    """kind      null, parameters, single, pair, outside or disturbed, which is null or single
    hidden     names of the effects, also of those outside the catalogue
    values     by effect or, for `parameters`, by parameter: its parameters, SI
    size       RMS deviation of each effect alone from the nominal runs, sigma
    remains    the same beside the other effects, after re-fitting the nominal parameters
    spread     0: the nominal values are true; 1: drawn within their uncertainties
    engine     the physics engine
    realised   by effect: its realisation, if it has several
    same_as    by effect: other names of the catalogue that are equally correct
    disturbance  of the recordings, by name
    """

    kind: str
    hidden: tuple[str, ...]
    values: Mapping[str, Mapping[str, float]]
    size: Mapping[str, float]
    remains: Mapping[str, float]
    spread: float = 0.0
    engine: str = "mujoco"
    realised: Mapping[str, str] = field(default_factory=dict)
    same_as: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    disturbance: str = ""

    @classmethod
    def of(cls, answer: Mapping[str, Any]) -> Truth:
        """The truth of an opened answer."""
        hidden, effects = tuple(answer["hidden"]), answer["effects"]
        deviation = answer["rms_deviation_from_nominal_in_sigma"]
        named = dict(zip(hidden, effects, strict=False))
        return cls(
            kind=answer["kind"],
            hidden=hidden,
            values={
                one["name"]: {name: each["value"] for name, each in one["parameters"].items()}
                for one in effects
            },
            size={name: deviation[f"visibility_{name}"] for name in hidden},
            remains={name: answer["stays_visible"][name] for name in hidden},
            spread=answer["spread"],
            engine=answer["engine"],
            realised={n: one["realisation"] for n, one in named.items() if "realisation" in one},
            same_as={n: tuple(one["same_as"]) for n, one in named.items() if "same_as" in one},
            disturbance=answer.get("disturbance", ""),
        )

    @property
    def names(self) -> tuple[str, ...]:
        """The names of a correct diagnosis: effects of the catalogue, or wrong parameters."""
        return () if self.kind == "outside" else tuple(self.values)

    @property
    def nothing(self) -> bool:
        """Whether nothing is hidden, in disturbed recordings or others."""
        return self.kind == "null" or (self.kind == "disturbed" and not self.hidden)

    @property
    def detectable(self) -> bool:
        """Whether everything hidden remains visible after a re-fit."""
        return all(self.remains[name] >= FLOOR for name in self.hidden)

    @property
    def strength(self) -> str:
        """Of a single effect, by its size before a re-fit, however small or large; else empty."""
        if self.kind != "single":
            return ""
        size = self.size[self.hidden[0]]
        return next((name for name, (_, high) in STRENGTHS.items() if size < high), "strong")


@dataclass(frozen=True)
class Named:
    """An effect or a parameter that was named; intervals: 95 %, by parameter, SI."""

    name: str
    confidence: float
    intervals: Mapping[str, tuple[float, float]]

    @classmethod
    def of(cls, effect: Mapping[str, Any]) -> Named:
        """An entry of `effects`; an interval without both ends is left out."""
        ends = {name: each["ci95"] for name, each in effect["parameters"].items()}
        kept = {name: (low, high) for name, (low, high) in ends.items() if None not in (low, high)}
        return cls(str(effect["name"]), effect["confidence"] or 0.0, kept)


_FIT = tuple(f"heldout_rms_{when}" for when in ("before", "parameters", "after"))


def scored_part(diagnosis: Mapping[str, Any]) -> dict[str, Any]:
    """The part of a `diagnosis.json` that `Claim.of` reads. Raises as that does."""
    Claim.of(diagnosis)
    kept = ("verdict", "effects", "suspects", "indistinguishable", "mismatch", "remainder")
    evidence = diagnosis["location"]["evidence"]
    return {
        **{name: diagnosis[name] for name in kept if name in diagnosis},
        "fit": {name: diagnosis["fit"].get(name) for name in _FIT},
        "location": {"evidence": [{k: one[k] for k in ("test", "p_value")} for one in evidence]},
    }


@dataclass(frozen=True)
class Claim:
    """verdict    consistent, parameters, missing_physics or unexplained
    named       strongest first
    groups      names that the recordings cannot distinguish
    before, refitted, after  held-out misfit, RMS in sigma, 1 is the noise: nominal, with the
                parameters alone re-fitted, corrected; None where it is unknown
    p_values    by the test's name
    remainder   what is left with the named effects: none, small, large, or empty if not stated
    share       of the initial mismatch that remains
    suspects    names of what is only suspected
    """

    verdict: str
    named: tuple[Named, ...] = ()
    groups: tuple[frozenset[str], ...] = ()
    before: float | None = None
    refitted: float | None = None
    after: float | None = None
    p_values: Mapping[str, float] = field(default_factory=dict)
    remainder: str = ""
    share: float | None = None
    suspects: tuple[str, ...] = ()

    @classmethod
    def of(cls, diagnosis: Mapping[str, Any]) -> Claim:
        """The claim of a `diagnosis.json`.

        Raises KeyError, TypeError, ValueError or AttributeError if it is not one.
        """
        fit, remainder = diagnosis["fit"], diagnosis.get("remainder", {})
        p_values = {"any mismatch": diagnosis["mismatch"]["p_value"]}
        p_values |= {one["test"]: one["p_value"] for one in diagnosis["location"]["evidence"]}
        return cls(
            str(diagnosis["verdict"]),
            tuple(map(Named.of, diagnosis["effects"])),
            tuple(map(frozenset, diagnosis["indistinguishable"])),
            *(fit.get(name) for name in _FIT),
            p_values={test: p for test, p in p_values.items() if p is not None},
            remainder=remainder.get("size", ""),
            share=remainder.get("share"),
            suspects=tuple(str(one["name"]) for one in diagnosis.get("suspects", ())),
        )

    @property
    def names(self) -> tuple[str, ...]:
        """All names, strongest first."""
        return tuple(one.name for one in self.named)


@dataclass(frozen=True)
class Case:
    """What was hidden, and the diagnosis (None: no answer). wall, cpu: of the diagnosis, s."""

    id: str
    truth: Truth
    claim: Claim | None
    wall: float = 0.0
    cpu: float = 0.0
    why_none: str = ""

    @property
    def found(self) -> tuple[str, ...]:
        """The hidden names that were found, directly or by an equivalent."""
        said = self.claim.names if self.claim else ()
        return tuple(name for name in self.truth.names if any(self._stands(name, s) for s in said))

    @property
    def extra(self) -> tuple[str, ...]:
        """Named effects that match nothing hidden."""
        said = self.claim.names if self.claim else ()
        return tuple(s for s in said if not any(self._stands(name, s) for name in self.truth.names))

    def _stands(self, hidden: str, said: str) -> bool:
        """Whether a name matches a hidden one: the same, one for the same physics, or one that the
        diagnosis calls indistinguishable from it."""
        groups = self.claim.groups if self.claim else ()
        equal = said in (hidden, *self.truth.same_as.get(hidden, ()))
        return equal or any({said, hidden} <= group for group in groups)

    @property
    def outcome(self) -> str:
        """`right`, or the error in a few words."""
        claim, truth = self.claim, self.truth
        if claim is None:
            return "no answer"
        if truth.nothing:
            return "right" if claim.verdict == "consistent" else "false claim"
        if truth.kind == "outside" and any(one.confidence > SURE for one in claim.named):
            return "named with confidence"
        expected = {"parameters": "parameters", "outside": "unexplained"}
        if claim.verdict != expected.get(truth.kind, "missing_physics"):
            return f"said {claim.verdict}"
        return "right" if truth.kind in expected else self._naming()

    def _naming(self) -> str:
        """The outcome of the names in a claim of missing physics."""
        if len(self.found) == len(self.truth.names):
            return "right, and more" if self.extra else "right"
        if self.found:
            return "one of two, and a wrong one" if self.extra else "one of two"
        return "wrong name"

    @property
    def scored(self) -> bool:
        """Whether it counts in the headline; undetectable effects are counted separately."""
        return self.truth.detectable

    @property
    def missed(self) -> bool:
        """Whether it is listed as a miss. For an undetectable effect only a wrong name or no answer
        is one: explaining it by the parameters is then correct."""
        if self.scored:
            return self.outcome != "right"
        return self.claim is None or bool(self.claim.verdict == "missing_physics" and self.extra)
