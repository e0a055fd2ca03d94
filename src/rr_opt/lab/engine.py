"""MuJoCo, which is loaded when it is first needed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from rr_opt.outcome import InputError


def engine() -> Any:
    """The module mujoco. Raises InputError if it is not installed."""
    try:
        mujoco: Any = import_module("mujoco")
        import_module("mujoco.rollout")
    except ImportError:
        raise InputError(
            "The virtual laboratory has no engine: MuJoCo is not installed. Expected the package "
            "mujoco. Install it with: pip install 'rr-opt[lab]', or take the engine planar."
        ) from None
    # Its warnings would go to a file in the working folder; `Plant.require_sound` looks for them.
    mujoco.set_mju_user_warning(_silent)
    return mujoco


def _silent(_: str) -> None:
    pass
