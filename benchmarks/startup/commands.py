"""What is timed: the floors, and each verb on the smallest input that makes sense."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import yaml

from benchmarks.fit.case import GAITS, SIGMA, TRUE, case
from benchmarks.fit.equations import B1, B2, C1, C2, M1, M2, H
from rr_opt.model.experiment import CHANNELS

FLOORS: Mapping[str, str] = {
    "python -c pass": "pass",
    "python -c 'import rr_opt'": "import rr_opt",
    "python -c 'import numpy'": "import numpy",
    "python -c 'import casadi'": "import casadi",
}
LIGHT = ("--version", "--help", "schema", "lint", "export", "inspect")
"""Verbs that compute next to nothing, and are timed more often."""
LONG = ("reproduce", "calibrate")
"""Verbs whose input cannot be made smaller: a minute and more each, so they are timed once."""

_SAMPLES = 501


def verbs(folder: Path) -> Mapping[str, Sequence[str]]:
    """Arguments by verb; what they write goes to the folder, in which inputs are made."""
    lab = folder / "lab"
    _experiment(lab)
    study = folder / "study.yaml"
    study.write_text("vary:\n  limits.rate: [20 rpm, 30 rpm]\n", encoding="utf-8")
    gait = ("--amplitude", "0.4", "--period", "1")
    out = {name: ("--out", str(folder / name)) for name in
           ("export.csv", "sweep", "simulate", "best", "turn", "chart", "study",
            "record", "diagnose", "shapes", "reproduce", "calibrate", "prove")}  # fmt: skip
    return {
        "--version": ("--version",),
        "--help": ("--help",),
        "schema": ("schema", "robot"),
        "lint": ("lint", "problems/loads"),
        "export": (
            "export",
            "results/prototype/result.json",
            "--format",
            "csv",
            *out["export.csv"],
        ),
        "inspect": ("inspect", str(lab)),
        "sweep": ("sweep", "--points", "100", *out["sweep"]),
        "simulate": ("simulate", *gait, "--seconds", "1", *out["simulate"]),
        "circle": ("circle", *gait, "--offset", "0.2"),
        "maximize-speed": ("maximize-speed", "--no-figures", *out["best"]),
        "turn": ("turn", "--radius", "1 m", "--no-figures", *out["turn"]),
        "turn-chart": ("turn-chart", *out["chart"]),
        "study": ("study", str(study), "--workers", "1", "--restart", *out["study"]),
        "record": ("record", "--gait", "0.5, 1 s", "--seconds", "2", *out["record"]),
        "diagnose": ("diagnose", str(lab), *out["diagnose"]),
        "shapes": ("shapes", "--no-figures", *out["shapes"]),
        "prove": (
            "prove",
            *("--cases", "1", "--kinds", "null", "--seed", "5eed", "--workers", "1", "--restart"),
            *out["prove"],
        ),
        "reproduce": ("reproduce", "--no-figures", *out["reproduce"]),
        "calibrate": ("calibrate", *out["calibrate"]),
    }


def program() -> str:
    """The command as installed beside this Python."""
    return str(Path(sys.executable).with_name("rr-opt"))


def _experiment(folder: Path) -> None:
    """Three recordings of 5 s of the robot of benchmarks/fit."""
    folder.mkdir()
    seen = case()
    told = []
    for run, use in enumerate(("fit", "fit", "holdout")):
        table = np.column_stack([seen.t[:_SAMPLES], seen.values[run, :_SAMPLES]])
        name = f"run{run}.csv"
        head = ",".join(("t", *CHANNELS))
        np.savetxt(folder / name, table, fmt="%.6f", delimiter=",", header=head, comments="")
        gait = dict(zip(("amplitude", "period", "offset"), GAITS[run], strict=True))
        told.append({"file": name, "use": use, "start": "running", "gait": gait})
    kappa1, kappa2, I1, I2, a1, a2 = TRUE.tolist()
    whole = {
        "robot": {
            "platform1": {"m": M1, "I": I1, "c": C1, "a": a1, "b": B1, "kappa": kappa1},
            "platform2": {"m": M2, "I": I2, "c": C2, "a": a2, "b": B2, "kappa": kappa2},
            "h": H,
        },
        "noise": {"position": float(SIGMA[0]), "angle": float(SIGMA[2])},
        "recordings": told,
    }
    (folder / "experiment.yaml").write_text(yaml.safe_dump(whole), encoding="utf-8")
