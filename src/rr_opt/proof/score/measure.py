"""A count with the sentence that defines it."""

from __future__ import annotations

from dataclasses import dataclass

from rr_opt.proof.score.rate import Rate


@dataclass(frozen=True)
class Measure:
    """name: short, for scripts; title: for people; definition: what is counted, of what."""

    name: str
    title: str
    definition: str
    rate: Rate
