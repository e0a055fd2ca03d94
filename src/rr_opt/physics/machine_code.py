"""C source made into a library of this machine, where a C compiler is at hand.

What was compiled is kept in the user's cache folder, by the hash of its source.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
from functools import lru_cache
from pathlib import Path

_SECONDS = 60
"""A compiler that takes longer is not waited for."""

_NATIVE = "-march=native"


def library(source: str, flags: tuple[str, ...], *, make: bool) -> ctypes.CDLL | None:
    """What was compiled before, or is now if `make`; None where that cannot be."""
    compiler = shutil.which(os.environ.get("CC", "cc"))
    folder = _cache()
    if not compiler or not folder:
        return None
    # A home may be shared by machines; what one of them calls native another may not have.
    machine = (_processor(),) if _NATIVE in flags else ()
    key = hashlib.sha256("\n".join((source, compiler, *flags, *machine)).encode()).hexdigest()[:32]
    made = folder / f"{key}.so"
    try:
        if not made.exists():
            if not make:
                return None
            _compile(compiler, source, flags, made)
        return ctypes.CDLL(str(made))
    except (OSError, subprocess.SubprocessError):
        return None


def _compile(compiler: str, source: str, flags: tuple[str, ...], library: Path) -> None:
    with tempfile.TemporaryDirectory(dir=library.parent) as place:
        code, made = Path(place) / "system.c", Path(place) / "system.so"
        code.write_text(source, encoding="utf-8")
        subprocess.run(
            [compiler, *flags, "-o", str(made), str(code), "-lm"],
            check=True,
            capture_output=True,
            timeout=_SECONDS,
        )
        made.replace(library)


@lru_cache
def _processor() -> str:
    """What tells one kind of processor from another."""
    told = {"vendor_id", "model name", "flags", "Features", "CPU part"}
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    own = sorted({line for line in lines if line.split(":")[0].strip() in told})
    return "\n".join((platform.machine(), platform.processor(), *own))


def _cache() -> Path | None:
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    folder = Path(base) / "rr-opt"
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError:
        return None
    # Code that another user could have put there is not run.
    mine = not hasattr(os, "getuid") or folder.stat().st_uid == os.getuid()
    return folder if mine and os.access(folder, os.W_OK) else None
