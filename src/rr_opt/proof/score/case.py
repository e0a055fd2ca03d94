"""One case with its answer opened, and how it came out."""

from __future__ import annotations

from dataclasses import dataclass

from rr_opt.proof.score.claim import Claim
from rr_opt.proof.score.truth import Truth

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
        """The hidden names that were named, themselves or by one that the diagnosis says cannot be
        told from it."""
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
        if truth.kind == "null":
            return "right" if claim.verdict == "consistent" else "false claim"
        if truth.kind == "parameters":
            return "right" if claim.verdict == "parameters" else f"said {claim.verdict}"
        if truth.kind == "outside":
            return _of_outside(claim)
        return self._of_named(claim)

    @property
    def scored(self) -> bool:
        """Whether it counts in the headline: what nobody can see is told apart."""
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
