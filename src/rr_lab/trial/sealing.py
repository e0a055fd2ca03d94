"""A drawn case driven, recorded and sealed."""

from __future__ import annotations

import json
import secrets
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from rr_lab.case import Case, stream
from rr_lab.effect_size import Detectability
from rr_lab.effects import effect_named
from rr_lab.files import Delivery, answer, folder_of, seal_of
from rr_lab.random_case import random_case
from rr_lab.trial.draws import Draw
from rr_opt.outcome import NotConvergedError

TORQUE = 0.3
"""The share of cases whose recordings have the servo's torque."""


@dataclass(frozen=True)
class SealedCase:
    """files by name; answer, a JSON text with a random word in it; seal, its SHA-256; seconds of
    CPU. Where the laboratory failed, why, and nothing else."""

    files: Mapping[str, bytes]
    answer: str
    seal: str
    seconds: float
    failed: str = ""


def make(draw: Draw, seconds: float = 30.0) -> SealedCase:
    """Drive and record a case; seconds: length of each run.

    If the engine fails, `failed` says why; nothing is raised.
    """
    began = time.process_time()
    try:
        case = random_case(
            draw.seed, draw.kind, target=draw.target, spread=draw.spread, seconds=seconds,
            engine=draw.engine, disturbance=draw.disturbance,
        )  # fmt: skip
        text = _answer_text(case, draw)
        with_torque = stream(draw.seed, "torque").random() < TORQUE
        files = dict(folder_of(case, Delivery(torque=bool(with_torque))))
    except NotConvergedError as error:
        return SealedCase({}, "", "", time.process_time() - began, str(error))
    return SealedCase(files, text, seal_of(text), time.process_time() - began)


def _answer_text(case: Case, draw: Draw) -> str:
    """The laboratory's answer, what was drawn, and how detectable each effect is."""
    data: dict[str, Any] = {
        "number": draw.number,
        "kind": "disturbed" if draw.disturbance else draw.kind.partition(":")[0],
        "hidden": [effect_named(use.name).name for use in case.effects],
        "spread": draw.spread,
        **answer(case),
        "stays_visible": _remains(case),
        # So that the seal of a guess never matches.
        "salt": secrets.token_hex(16),
    }
    return json.dumps(data, indent=2) + "\n"


def _remains(case: Case) -> dict[str, float]:
    """RMS in sigma that each effect alone leaves after the parameters are re-fitted."""
    if not case.effects:
        return {}
    case = replace(case, disturbance="")
    refit, nominal = Detectability.of(case), replace(case, robot=case.nominal)
    return {
        effect_named(use.name).name: float(f"{refit.remains(replace(nominal, effects=(use,))):.4g}")
        for use in case.effects
    }
