"""The notebooks run, and what they show is what comes out of them."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
EXECUTE = """
import sys
import nbclient, nbformat
book = nbformat.read(sys.argv[1], 4)
nbclient.NotebookClient(book, timeout=600, kernel_name="python3").execute()
nbformat.write(book, sys.argv[2])
"""


def shown(path):
    """What a notebook prints, as words and numbers, and which pictures it shows."""
    nbformat = pytest.importorskip("nbformat")
    outputs = [one for cell in nbformat.read(path, 4).cells for one in cell.get("outputs", [])]
    text = "".join(one.get("text", "") for one in outputs)
    pictures = ["image/svg+xml" in one.get("data", {}) for one in outputs]
    number = r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?"
    return re.sub(number, "#", text), [float(n) for n in re.findall(number, text)], pictures


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_is_shown_is_what_comes_out(path, tmp_path):
    pytest.importorskip("nbclient")
    again = tmp_path / path.name
    done = subprocess.run(
        [sys.executable, "-c", EXECUTE, path, again],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    words, numbers, pictures = shown(path)
    words_again, numbers_again, pictures_again = shown(again)
    assert (words, pictures) == (words_again, pictures_again)
    # The error of a check is rounding; what else is printed has four digits.
    assert numbers_again == pytest.approx(numbers, rel=0.02, abs=2e-3)
    assert True in pictures


def test_there_are_three_and_small_ones():
    assert {path.stem for path in NOTEBOOKS} == {"best-gait", "diagnosis", "study"}
    assert all(path.stat().st_size < 100_000 for path in NOTEBOOKS)
