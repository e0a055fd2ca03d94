"""Name and fingerprint of a problem or an experiment, wherever it came from."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from rr_opt.model.experiment import Experiment
from rr_opt.model.problem import Problem


def identity(asked: Problem | Experiment) -> tuple[str, str]:
    """Its name, and the SHA-256 of its files, or of its values where there is no file."""
    name = asked.name or asked.robot.name or type(asked).__name__.lower()
    return name, asked.sha256 or fingerprint(asked)


def fingerprint(value: Any) -> str:
    """SHA-256, in hex, over the values; equal objects have equal ones."""
    return hashlib.sha256(_canonical(value)).hexdigest()


def _canonical(value: Any) -> bytes:
    if dataclasses.is_dataclass(value):
        parts = [(one.name, getattr(value, one.name)) for one in dataclasses.fields(value)]
        return type(value).__name__.encode() + _canonical(dict(parts))
    if isinstance(value, Mapping):
        return b"{" + b"".join(_canonical(key) + _canonical(value[key]) for key in value) + b"}"
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape}".encode() + value.tobytes()
    if isinstance(value, tuple | list):
        return b"(" + b"".join(map(_canonical, value)) + b")"
    return f"{value!r},".encode()
