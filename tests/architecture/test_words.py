"""No file names a package registry's host, a place on one machine, or a folder outside."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

# The names and their ends are apart, so that this file does not match itself.
HOSTS = {
    "pypi": "org",
    "pythonhosted": "org",
    "npmjs": "org|com",
    "debian": "org",
    "anaconda": "org|com",
    "crates": "io",
    "proxy.golang": "org",
}
PLACES = ("work", "tmp", "root", "home", "Users", "opt")
OUTSIDE = "shared"
FORBIDDEN = re.compile(
    "|".join(
        [rf"\b{re.escape(name)}\.(?:{ends})\b" for name, ends in HOSTS.items()]
        + [rf"(?<![\w.}})])/{place}/" for place in PLACES]
        + [rf"\.\./{OUTSIDE}\b"]
    )
)


def listed():
    """Every file that git tracks or would track."""
    run = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        check=False,
    )
    if run.returncode:
        pytest.skip("not a git checkout")
    return [ROOT / name for name in sorted(set(run.stdout.decode().split("\0")) - {""})]


def text_of(path):
    try:
        return path.read_text(encoding="utf-8")
    except (UnicodeDecodeError, OSError):
        return ""  # a picture, or a file that was just removed


def test_no_file_says_them():
    said = [
        f"{path.relative_to(ROOT)}: {found[0]}"
        for path in listed()
        for found in FORBIDDEN.finditer(text_of(path))
    ]
    assert said == []


@pytest.mark.parametrize(
    "text",
    [f"https://{name}.{end}/x" for name, ends in HOSTS.items() for end in ends.split("|")]
    + [f"see '/{place}/main'" for place in PLACES]
    + [f"cat ../{OUTSIDE}/x"],
)
def test_it_would_be_seen(text):
    assert FORBIDDEN.search(text)


@pytest.mark.parametrize("text", ["m/s", "frame/work/x", "{root}/tmp/x", "docs/home/a"])
def test_other_words_are_not(text):
    assert not FORBIDDEN.search(text)
