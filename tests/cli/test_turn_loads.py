"""A turn by whole loads is swept at whole loads: no number between them refutes it."""

from __future__ import annotations

import json
from pathlib import Path

LOADS = Path(__file__).parents[2] / "problems" / "loads"


def test_whole_loads(run):
    done = run("turn", str(LOADS), "--radius", "1", "--no-figures", "--json")
    assert done.exit_code == 0
    reported = json.loads(done.stdout)
    assert reported["check"]["gap"] >= -1e-4
    assert reported["loads"] == round(reported["loads"])
