"""A library is loaded from the cache only if this user compiled it and nobody can have changed it.

Whatever is refused is compiled again: the code that runs is always that of the source.
"""

import _ctypes
import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from rr_opt.mechanics import compile_cache
from rr_opt.mechanics.compile_cache import library

pytestmark = pytest.mark.skipif(not shutil.which("cc"), reason="there is no C compiler")

SOURCE = "int answer(void) { return 42; }"
PLANTED = "int answer(void) { return 666; }"
FLAGS = ("-O0", "-fPIC", "-shared")


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """The cache folder, private and empty; other libraries of this process are elsewhere."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("CC", raising=False)
    (tmp_path / "process").mkdir(mode=0o700)
    monkeypatch.setattr(compile_cache, "_process_folder", lambda: tmp_path / "process")
    return tmp_path / "cache" / "rr-opt"


@pytest.fixture
def compiled(cache):
    """The path of the library of SOURCE in the cache."""
    assert answer(make=True) == 42
    (path,) = cache.glob("*.so")
    return path


def answer(source=SOURCE, *, make):
    """What the library of a source answers, or None."""
    made = library(source, FLAGS, make=make)
    if made is None:
        return None
    number = made.answer()
    # Else the process would be given this one again for whatever is at its path.
    _ctypes.dlclose(made._handle)
    return number


def plant(path, record=True):
    """Put another library at a path, and a record that fits if asked for."""
    code = path.with_suffix(".c")
    code.write_text(PLANTED)
    subprocess.run(["cc", *FLAGS, "-o", str(path), str(code)], check=True)
    path.chmod(0o600)
    if record:
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        path.with_suffix(".sha256").write_text(f"{digest}  {path.name}\n")


def test_a_source_given_as_text_is_kept_under_its_key(cache):
    def written():
        raise AssertionError("a cached library needs no source")

    for source, make in ((SOURCE, True), (written, False)):
        assert library(source, FLAGS, make=make, key="what it is made from").answer() == 42


def test_what_was_compiled_is_found_again(compiled):
    assert answer(make=False) == 42
    for path in (compiled.parent, compiled, compiled.with_suffix(".sha256")):
        assert path.stat().st_mode & 0o077 == 0
    assert sorted(one.suffix for one in compiled.parent.iterdir()) == [".sha256", ".so"]


def test_the_record_is_one_that_sha256sum_checks(compiled):
    if not shutil.which("sha256sum"):
        pytest.skip("there is no sha256sum")
    record = compiled.with_suffix(".sha256").name
    subprocess.run(["sha256sum", "--check", record], cwd=compiled.parent, check=True)


def damaged(how, path):
    content = path.read_bytes()
    path.unlink()
    if how == "folder":
        path.mkdir()
    else:
        path.write_bytes({"short": content[:4096], "empty": b"", "junk": b"no library"}[how])


@pytest.mark.parametrize("how", ["short", "empty", "junk"])
def test_a_damaged_library_is_compiled_again(how, compiled):
    damaged(how, compiled)
    assert answer(make=False) is None
    assert answer(make=True) == 42
    assert answer(make=False) == 42


def test_what_cannot_be_replaced_is_compiled_elsewhere(compiled):
    damaged("folder", compiled)
    assert answer(make=False) is None
    assert answer(make=True) == 42


@pytest.mark.parametrize("record", ["", "0" * 64, "\xff", None])
def test_a_library_without_its_record_is_not_loaded(record, compiled):
    path = compiled.with_suffix(".sha256")
    path.unlink() if record is None else path.write_text(record, encoding="latin-1")
    plant(compiled, record=False)
    assert answer(make=False) is None
    assert answer(make=True) == 42


@pytest.mark.parametrize("bits", [0o770, 0o707, 0o777])
@pytest.mark.parametrize("level", ["folder", "above"])
def test_a_folder_that_others_can_write_is_not_used(bits, level, compiled):
    plant(compiled)
    assert answer(make=False) == 666, "the plant has to be one that would be loaded"
    (compiled.parent if level == "folder" else compiled.parent.parent).chmod(bits)
    assert answer(make=False) is None
    assert answer(make=True) == 42


def test_the_sticky_bit_above_keeps_a_folder_private(compiled):
    compiled.parent.parent.chmod(0o1777)
    assert answer(make=False) == 42


@pytest.mark.parametrize("suffix", [".so", ".sha256"])
def test_a_file_that_others_can_write_is_not_loaded(suffix, compiled):
    plant(compiled)
    compiled.with_suffix(suffix).chmod(0o666)
    assert answer(make=False) is None
    assert answer(make=True) == 42


@pytest.mark.parametrize("suffix", [".so", ".sha256"])
def test_a_link_is_not_followed(suffix, compiled, tmp_path):
    plant(compiled)
    path = compiled.with_suffix(suffix)
    path.rename(tmp_path / path.name)
    path.symlink_to(tmp_path / path.name)
    assert answer(make=False) is None
    assert answer(make=True) == 42


def test_a_cache_folder_that_is_a_link_is_not_used(compiled, tmp_path):
    plant(compiled)
    compiled.parent.rename(tmp_path / "other")
    compiled.parent.symlink_to(tmp_path / "other")
    assert answer(make=False) is None
    assert answer(make=True) == 42


def test_what_belongs_to_another_user_is_not_loaded(compiled, monkeypatch):
    plant(compiled)
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert answer(make=False) is None


@pytest.mark.skipif(os.getuid() != 0, reason="only root can give files away")
@pytest.mark.parametrize("level", ["file", "folder", "above"])
def test_what_was_planted_by_another_user_is_not_loaded(level, compiled):
    plant(compiled)
    folder = compiled.parent
    os.chown({"file": compiled, "folder": folder, "above": folder.parent}[level], 65534, 65534)
    assert answer(make=False) is None
    assert answer(make=True) == 42


def test_without_a_cache_folder_code_is_compiled_for_the_process(tmp_path, cache, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert answer(make=False) is None
    assert answer(make=True) == 42


def test_a_user_without_a_home_has_no_cache_folder(cache, monkeypatch):
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.delenv("HOME")
    monkeypatch.setattr(os.path, "expanduser", lambda path: path)  # no entry in /etc/passwd
    assert answer(make=False) is None
    assert answer(make=True) == 42


def test_the_folder_of_a_process_is_private_and_removed(tmp_path):
    code = (
        "from rr_opt.mechanics.compile_cache import _process_folder\n"
        "folder = _process_folder()\n"
        "print(folder, oct(folder.stat().st_mode & 0o777))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    folder, mode = done.stdout.split()
    assert mode == "0o700"
    assert not Path(folder).exists()


def test_a_compiler_with_arguments(cache, monkeypatch):
    monkeypatch.setenv("CC", "cc -DANSWER='(40 + 3)'")
    assert answer("int answer(void) { return ANSWER; }", make=True) == 43


@pytest.mark.parametrize("compiler", ["no-such-compiler", "cc 'unbalanced", "cc --no-such-option"])
def test_without_a_compiler_there_is_no_library(compiler, cache, monkeypatch):
    monkeypatch.setenv("CC", compiler)
    assert answer(make=True) is None


def test_an_empty_cc_is_none(cache, monkeypatch):
    monkeypatch.setenv("CC", "")
    assert answer(make=True) == 42
