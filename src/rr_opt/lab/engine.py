"""MuJoCo, which is loaded when it is first needed."""

from __future__ import annotations

import ctypes
from functools import cache
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
    _stop_clock(mujoco)
    return mujoco


@cache
def _stop_clock(mujoco: Any) -> None:
    """Keep MuJoCo from timing the parts of each step, which nobody reads: with a model as small as
    this, to look at the clock so often takes a sixth of the time."""
    try:
        # MuJoCo has no clock unless it is given one. Its Python package gives it one and only ever
        # puts another in its place, so the library is asked where it is kept.
        library = ctypes.CDLL(mujoco._callbacks.__file__)
        ctypes.c_void_p.in_dll(library, "mjcb_time").value = None
    except (AttributeError, OSError, ValueError):
        return  # Slower, and otherwise the same.


def _silent(_: str) -> None:
    pass
