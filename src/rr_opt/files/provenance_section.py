"""The robot file's `provenance`: for each value, whether it was measured, fitted or assumed."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from rr_opt.files.document import Document, Path, path_text
from rr_opt.files.issue import Issue, shown, unknown_word
from rr_opt.files.robot_model import PlatformModel, RobotModel, ServoModel

ORIGINS = ("measured", "fitted", "assumed")

_KEYS: dict[str, tuple[str, ...]] = {
    "": tuple(key for key in RobotModel.model_fields if key not in ("name", "provenance")),
    "platform1": tuple(PlatformModel.model_fields),
    "platform2": tuple(PlatformModel.model_fields),
    "servo": tuple(ServoModel.model_fields),
}


def read_provenance(document: Document) -> tuple[Mapping[str, str], list[Issue]]:
    """Key path -> the sentence that says where the value comes from.

    A friction given as `k` is told under `kappa`, the name by which the robot keeps it.
    """
    found: dict[str, str] = {}
    issues: list[Issue] = []

    def walk(value: Any, path: Path) -> None:
        here = ("provenance", *path)
        if isinstance(value, dict):
            known = _KEYS.get(path_text(path))
            for key, inner in value.items():
                if known is not None and key not in known:
                    message = unknown_word(key, known, "key")
                    issues.append(document.issue("error", (*here, key), message))
                else:
                    walk(inner, (*path, key))
        elif not path or not isinstance(value, str) or not value.startswith(ORIGINS):
            message = (
                f"Read {shown(value)}. Expected a text that begins with {', '.join(ORIGINS)}. "
                "Write for example `measured: Table 1`, in quotes."
            )
            issues.append(document.issue("error", here, message))
        else:
            kept = (*path[:-1], "kappa") if path[-1] == "k" else path
            found[path_text(kept)] = value

    walk(document.data["provenance"], ())
    return MappingProxyType(found), issues
