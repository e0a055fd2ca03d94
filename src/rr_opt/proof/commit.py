"""The seed of a published trial: the hash of the commit that it is run on.

Nobody can choose such a seed, as it changes with every change of the code that it tries.
"""

from __future__ import annotations

import hashlib
import subprocess
from pathlib import Path

from rr_opt.outcome import InputError

_HINT = "Commit the changes, or give a seed of your own with --seed."


def seed_of_commit(source: Path, results: Path) -> str:
    """The hash of the commit that the code in `source` is at, 40 hexadecimal digits.

    results: a folder in which changes are none of the code. Raises InputError if there is no
    commit, or files differ from it.
    """
    try:
        commit = _git(source, "rev-parse", "HEAD").strip()
        top = Path(_git(source, "rev-parse", "--show-toplevel").strip())
        own = []
        if results.resolve().is_relative_to(top):
            own = [f":(exclude,top){results.resolve().relative_to(top)}"]
        changed = _git(top, "status", "--porcelain", "--", ".", *own).splitlines()
    except (OSError, subprocess.CalledProcessError):
        raise InputError(
            f"The code in {source} is in no git repository. Expected a commit, whose hash is the "
            "seed. Give a seed of your own with --seed."
        ) from None
    if changed:
        more = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        raise InputError(
            f"Read changes that are in no commit: {changed[0].strip()}{more}. Expected the code as "
            f"it was committed, since the commit's hash is the seed. {_HINT}"
        )
    return commit


def read_seed(text: str) -> str:
    """A seed of the user's own, hexadecimal digits. Raises InputError for anything else."""
    word = text.strip().lower().removeprefix("0x")
    if not word or set(word) - set("0123456789abcdef"):
        raise InputError(
            f"--seed: Read {text!r}. Expected hexadecimal digits such as 1f3a, or `commit` for the "
            "hash of the commit. Correct it."
        )
    return word


def fingerprint(source: Path) -> str:
    """SHA-256 over the names and contents of all files of a package, as C and YAML decide what is
    computed too. What Python compiled from them is left out."""
    sums = hashlib.sha256()
    paths = (path for path in source.rglob("*") if path.is_file())
    for path in sorted(path for path in paths if "__pycache__" not in path.parts):
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        sums.update(f"{path.relative_to(source).as_posix()} {digest}\n".encode())
    return sums.hexdigest()


def _git(folder: Path, *words: str) -> str:
    return subprocess.run(
        ["git", "-C", str(folder), *words], capture_output=True, text=True, check=True
    ).stdout
