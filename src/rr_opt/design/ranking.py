"""Which candidates are finds of one optimum."""

from __future__ import annotations

import math

from rr_opt.design.setting import Setting
from rr_opt.design.solve import Candidate


def distinct(ranked: list[tuple[Setting, Candidate]]) -> list[tuple[Setting, Candidate]]:
    """One of each optimum; a gait and its mirror image (phi0 and -phi0) are one if alike."""
    kept: list[tuple[Setting, Candidate]] = []
    for setting, one in ranked:
        if not any(
            setting is other and _same(one, twin, setting.dynamics.mirrored) for other, twin in kept
        ):
            kept.append((setting, one))
    return kept


def _same(one: Candidate, other: Candidate, mirrored: bool) -> bool:
    """Before their meshes are refined, two finds of one optimum differ a little."""
    a, b = one.gait, other.gait
    offsets = (abs(a.offset), abs(b.offset)) if mirrored else (a.offset, b.offset)
    return (
        one.sign == other.sign
        and math.isclose(one.speed, other.speed, rel_tol=1e-3)
        and math.isclose(a.amplitude, b.amplitude, rel_tol=1e-2)
        and math.isclose(a.period, b.period, rel_tol=1e-2)
        and math.isclose(*offsets, abs_tol=1e-2)
        and math.isclose(one.share, other.share, abs_tol=1e-2)
    )
