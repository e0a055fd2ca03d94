"""A case made and sealed: the folder that is diagnosed, and the answer apart from it."""

from __future__ import annotations

import json
import secrets
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from rr_opt.lab.answer import answer, seal_of
from rr_opt.lab.case import Case
from rr_opt.lab.folder import folder_of
from rr_opt.lab.random_case import random_case
from rr_opt.outcome import NotConvergedError
from rr_opt.proof.lots import Lot
from rr_opt.proof.refitted import Refit


@dataclass(frozen=True)
class Made:
    """files by name; answer, a JSON text with a random word in it; seal, its SHA-256; seconds of
    CPU. Where the laboratory failed, why, and nothing else."""

    files: Mapping[str, bytes]
    answer: str
    seal: str
    seconds: float
    failed: str = ""


def make(lot: Lot, seconds: float = 30.0) -> Made:
    """Draw, drive and record a case; seconds: length of each run.

    A motion that the engine loses is told, and not raised.
    """
    began = time.process_time()
    try:
        case = random_case(
            lot.seed,
            lot.kind,
            target=lot.target,
            spread=lot.spread,
            seconds=seconds,
            engine=lot.engine,
        )
        text = _answer_text(case, lot)
        files = dict(folder_of(case))
    except NotConvergedError as error:
        return Made({}, "", "", time.process_time() - began, str(error))
    return Made(files, text, seal_of(text), time.process_time() - began)


def _answer_text(case: Case, lot: Lot) -> str:
    """The laboratory's answer, what the lot was, and how visible each effect stays."""
    told: dict[str, Any] = {
        "number": lot.number,
        "kind": lot.kind.partition(":")[0],
        "hidden": [use.name for use in case.effects],
        "spread": lot.spread,
        **answer(case),
        "stays_visible": _stays_visible(case),
        # So that the seal of a guess never matches.
        "salt": secrets.token_hex(16),
    }
    return json.dumps(told, indent=2) + "\n"


def _stays_visible(case: Case) -> dict[str, float]:
    """RMS in sigma that each effect alone leaves after the parameters are re-fitted."""
    if not case.effects:
        return {}
    refit, nominal = Refit.of(case), replace(case, robot=case.nominal)
    return {
        use.name: float(f"{refit.left(replace(nominal, effects=(use,))):.4g}")
        for use in case.effects
    }
