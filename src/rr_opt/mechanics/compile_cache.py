"""Generated C source as libraries, compiled once it pays and cached between runs.

Loading a library runs its code, so the cache is loaded from only where no other user can have put
anything: regular files of this user, in a folder that this user alone can write, below folders that
only this user and root can write. A library is loaded only if it has the SHA-256 that was recorded
when it was compiled: what was cut short or overwritten is compiled again. Where the cache folder
fails this test, libraries go to a folder that lasts as long as the process.

Without a C compiler, or where files have no owners, everything runs without compiled code.
"""

import atexit
import ctypes
import hashlib
import os
import platform
import shlex
import shutil
import stat
import subprocess
import tempfile
from collections.abc import Callable, Iterable
from functools import lru_cache
from pathlib import Path
from typing import Generic, TypeVar

import casadi as ca

_COMPILE_SECONDS = 60
"""A compiler that takes longer is stopped. The largest source here takes some ten seconds."""

_WRITABLE_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH


def library(
    source: str | Callable[[], str], flags: tuple[str, ...], *, make: bool, key: str = ""
) -> ctypes.CDLL | None:
    """The library of a C source: the cached one, else compiled now if `make`; None if neither.

    The compiler is $CC, which may hold arguments, or `cc`.

    key  what a source is made from, if making it takes time: it is then made only to be compiled
    """
    compiler = _compiler()
    if compiler is None or not hasattr(os, "geteuid"):
        return None
    if isinstance(source, str):
        key = key or source
    key = "\n".join((key, *compiler, *flags, _processor()))
    name = hashlib.sha256(key.encode()).hexdigest()[:32] + ".so"
    for folder in (_user_folder, _process_folder) if make else (_user_folder,):
        place = folder()
        if place is None:
            continue
        loaded = _loaded(place / name)
        if loaded is None and make:
            try:
                text = source if isinstance(source, str) else source()
                _compile([*compiler, *flags], text, place / name)
            except subprocess.SubprocessError:
                return None
            except OSError:  # a full disk, or one that is read-only
                continue
            loaded = _loaded(place / name)
        if loaded is not None:
            return loaded
    return None


def _compiler() -> list[str] | None:
    try:
        command = shlex.split(os.environ.get("CC", "")) or ["cc"]
    except ValueError:  # quotes that do not match
        return None
    path = shutil.which(command[0])
    return [path, *command[1:]] if path else None


@lru_cache
def _processor() -> str:
    """The kind of processor: a home folder may be shared by machines of several kinds."""
    keys = {"vendor_id", "model name", "flags", "Features", "CPU part"}
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    own = sorted({line for line in lines if line.split(":")[0].strip() in keys})
    return "\n".join((platform.machine(), platform.processor(), *own))


def _user_folder() -> Path | None:
    """The user's cache folder; None where another user could write."""
    try:
        base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
        # Resolved once: a link that changes after the check leads nowhere else.
        folder = Path(base).resolve() / "rr-opt"
        for missing in [one for one in (*folder.parents[::-1], folder) if not one.exists()]:
            missing.mkdir(mode=0o700, exist_ok=True)
        return folder if _is_private(folder) else None
    except (OSError, RuntimeError):
        return None


@lru_cache
def _process_folder() -> Path | None:
    """A folder of this process, removed at its end."""
    try:
        folder = Path(tempfile.mkdtemp(prefix="rr-opt-")).resolve()
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        return folder if _is_private(folder) else None
    except OSError:
        return None


def _is_private(folder: Path) -> bool:
    """Whether this user alone can write in a folder, and only this user or root can replace it.

    In a folder with the sticky bit, such as /tmp, nobody can replace what others own.
    """
    own = folder.lstat()
    if not stat.S_ISDIR(own.st_mode) or not _is_own(own):
        return False
    above = [parent.lstat() for parent in folder.parents]
    return all(
        one.st_uid in (0, os.geteuid())
        and (not one.st_mode & _WRITABLE_BY_OTHERS or one.st_mode & stat.S_ISVTX)
        for one in above
    )


def _is_own(entry: os.stat_result) -> bool:
    return entry.st_uid == os.geteuid() and not entry.st_mode & _WRITABLE_BY_OTHERS


def _loaded(path: Path) -> ctypes.CDLL | None:
    """The library at a path in a private folder; None unless it is the one that was compiled."""
    record = path.with_suffix(".sha256")
    try:
        for one in (path, record):
            entry = one.lstat()
            if not stat.S_ISREG(entry.st_mode) or not _is_own(entry):
                return None
        if record.read_text(encoding="utf-8") != _record(path, path.name):
            return None
        return ctypes.CDLL(str(path))
    except (OSError, ValueError):
        return None


def _record(library: Path, name: str) -> str:
    """A line that `sha256sum --check` reads."""
    return f"{hashlib.sha256(library.read_bytes()).hexdigest()}  {name}\n"


def _compile(command: list[str], source: str, library: Path) -> None:
    """Compile a source, and put library and record in place whole.

    Between the two a reader finds a library that does not match its record, and does without.
    """
    with tempfile.TemporaryDirectory(dir=library.parent) as folder:
        code, made, record = (Path(folder) / name for name in ("code.c", "code.so", "code.sha256"))
        code.write_text(source, encoding="utf-8")
        subprocess.run(
            [*command, "-o", str(made), str(code), "-lm"],
            check=True,
            capture_output=True,
            timeout=_COMPILE_SECONDS,
        )
        record.write_text(_record(made, library.name), encoding="utf-8")
        for one, end in ((made, library), (record, library.with_suffix(".sha256"))):
            one.chmod(0o600)
            one.replace(end)


def externals(
    name: str, functions: Iterable[ca.Function], flags: tuple[str, ...], *, make: bool
) -> tuple[ca.Function, ...] | None:
    """CasADi functions as machine code, together a library of this name; see `library`."""
    generator = ca.CodeGenerator(name, {"with_header": False})
    functions = tuple(functions)
    for function in functions:
        generator.add(function)
    made = library(generator.dump(), flags, make=make)
    if made is None:
        return None
    return tuple(ca.external(function.name(), made._name) for function in functions)


Code = TypeVar("Code")


class WhenItPays(Generic[Code]):
    """Compiled code of something that may be used once or a million times.

    Work is counted in a unit of the caller's. After `look` of it the cache is looked into, which
    takes a moment; after `pays`, compiling takes no longer than has been taken without.

    build  (make) -> the code from the cache, or compiled if `make`; None where that cannot be
    """

    def __init__(self, build: Callable[[bool], Code | None], *, look: int, pays: int) -> None:
        self._build, self._look, self._pays = build, look, pays
        self._work = 0
        self._code: Code | None = None

    def code(self, work: int) -> Code | None:
        """The compiled code if there is some, with so much work ahead."""
        before, self._work = self._work, self._work + work
        if self._code is None and any(
            before <= mark < self._work for mark in (self._look, self._pays)
        ):
            self._code = self._build(self._work > self._pays)
        return self._code
