"""A benchmark's results are text to read and strict JSON to compare, with where they were made."""

import json

import pytest

from benchmarks import results


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(results, "FOLDER", tmp_path / "bench")
    return tmp_path / "bench"


def test_both_files(folder):
    results.write("made", ["# Made", "", "text", ""], {"ours": 2.34567}, runs=3)
    assert (folder / "made.md").read_text(encoding="utf-8") == "# Made\n\ntext\n"
    told = json.loads((folder / "made.json").read_text(encoding="utf-8"))
    assert told == {"machine": results.machine(), "ratios": {"ours": 2.346}, "runs": 3}
    assert "Python 3" in told["machine"]


@pytest.mark.parametrize("ratio", [float("nan"), float("inf"), 0.0, -1.0])
def test_a_ratio_that_is_none_is_refused(folder, ratio):
    with pytest.raises(ValueError, match="no positive numbers: ours"):
        results.write("made", [], {"ours": ratio, "theirs": 1.0})
    assert not folder.exists()
