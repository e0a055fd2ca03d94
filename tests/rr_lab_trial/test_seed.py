"""A published trial's seed is the hash of a commit, and only of one that is what runs."""

import subprocess

import pytest

from rr_lab.trial.draws import CODE, fingerprint, read_seed, seed_of_commit
from rr_opt.outcome import InputError


def git(folder, *words):
    who = ("-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false")
    run = subprocess.run(
        ["git", "-C", str(folder), *who, *words], capture_output=True, text=True, check=True
    )
    return run.stdout.strip()


@pytest.fixture
def tree(tmp_path):
    """A repository with one commit."""
    top = tmp_path / "top"
    (top / "src").mkdir(parents=True)
    (top / "src" / "code.py").write_text("one = 1\n")
    git(top, "init", "--quiet")
    git(top, "add", ".")
    git(top, "commit", "--quiet", "-m", "one")
    return top


def test_the_hash_of_the_commit(tree):
    assert seed_of_commit(tree / "src", tree / "out") == git(tree, "rev-parse", "HEAD")


def test_results_are_no_change_of_the_code(tree):
    (tree / "out").mkdir()
    (tree / "out" / "proof.json").write_text("{}")
    assert seed_of_commit(tree / "src", tree / "out")


@pytest.mark.parametrize("file", ["src/code.py", "src/new.py", "outside.txt"])
def test_a_change_is_refused(tree, file):
    (tree / file).write_text("two = 2\n")
    with pytest.raises(
        InputError, match=r"uncommitted changes: .*Expected .*Commit the changes, or give"
    ):
        seed_of_commit(tree / "src", tree / "out")


def test_without_a_commit_it_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    with pytest.raises(InputError, match=r"not in a git repository.*Expected a commit.*--seed"):
        seed_of_commit(tmp_path, tmp_path / "out")


@pytest.mark.parametrize(("text", "seed"), [("1F3a", "1f3a"), ("0x10", "10"), (" 7 ", "7")])
def test_a_seed_of_ones_own(text, seed):
    assert read_seed(text) == seed


@pytest.mark.parametrize("text", ["", "xyz", "12 34", "0x"])
def test_what_is_no_seed(text):
    with pytest.raises(InputError, match="Expected hexadecimal digits"):
        read_seed(text)


def test_the_fingerprint_sees_every_file_of_the_code(tree):
    source = tree / "src"
    seen = [fingerprint(source)]
    (source / "data").mkdir()
    (source / "data" / "fit.c").write_text("double one = 1;\n")
    seen.append(fingerprint(source))
    (source / "data" / "fit.c").write_text("double one = 2;\n")
    seen.append(fingerprint(source))
    (source / "code.py").rename(source / "other.py")
    seen.append(fingerprint(source))
    assert len(set(seen)) == 4


def test_the_fingerprint_is_of_the_diagnosis_and_of_the_laboratory():
    assert {path.name for path in CODE} == {"rr_opt", "rr_lab"}
    assert all((path / "__init__.py").is_file() for path in CODE)
    assert fingerprint() == fingerprint(*CODE) != fingerprint(CODE[0])


def test_the_fingerprint_is_the_same_once_the_code_has_run(tree):
    before = fingerprint(tree / "src")
    (tree / "src" / "__pycache__").mkdir()
    (tree / "src" / "__pycache__" / "code.cpython-311.pyc").write_bytes(b"compiled")
    assert fingerprint(tree / "src") == before
