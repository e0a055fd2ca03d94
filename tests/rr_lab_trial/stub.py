"""Stands in for `rr-opt diagnose`: `python stub.py HOW FOLDER --out DIR --workers 1`.

HOW is what it does: says `consistent`, crashes (after its answer: late), never ends, writes
nonsense, or tells what it sees.
"""

import json
import os
import sys
import time
from pathlib import Path

HOW, FOLDER, OUT = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[4])
SAID = {
    "verdict": "consistent",
    "effects": [],
    "indistinguishable": [],
    "fit": {"heldout_rms_before": 1.0, "heldout_rms_after": 1.0},
    "mismatch": {"rms_beyond_noise": 0.0, "p_value": 0.5},
    "location": {"evidence": [{"test": "angle", "p_value": 0.5}]},
}


def main():
    sys.stdout.write(f"the stub says {HOW}\n")
    sys.stdout.flush()
    if HOW == "crash":
        raise SystemExit(3)
    if HOW == "die":
        os.abort()
    if HOW == "hang":
        time.sleep(600)
    OUT.mkdir()
    seen = {
        "cwd": str(Path.cwd()),
        "words": sys.argv[1:],
        "environment": dict(os.environ),
        "files": {str(path): path.read_text() for path in Path.cwd().parent.rglob("*")
                  if path.is_file()},
    }  # fmt: skip
    text = {"nonsense": "{", "strange": '{"verdict": 1}', "tell": json.dumps(SAID | seen)}
    (OUT / "diagnosis.json").write_text(text.get(HOW, json.dumps(SAID)))
    (OUT / "report.html").write_text("a page")
    if HOW == "late":
        raise SystemExit(4)


main()
