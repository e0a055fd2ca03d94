"""Every import contract of pyproject.toml fails, by its name, on an import it forbids."""

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CONTRACTS = {
    contract["id"]: contract["name"]
    for contract in tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"][
        "importlinter"
    ]["contracts"]
}

PLANTED = [
    ("layers", "robot/planted.py", "import rr_opt.physics.dynamics"),
    ("layers", "physics/planted.py", "import rr_opt.motion.cycle"),
    ("layers", "files/planted.py", "import rr_opt.motion.cycle"),
    ("layers", "motion/planted.py", "import rr_opt.files.units"),
    ("layers", "design/planted.py", "import rr_opt.cli.main"),
    ("check-apart-from-design", "verify/planted.py", "import rr_opt.design.solve"),
    ("check-apart-from-design", "design/planted.py", "import rr_opt.verify.replay"),
    ("sweep-apart-from-motion", "verify/sweep.py", "import rr_opt.motion.cycle"),
    ("figures-in-report", "verify/planted.py", "import matplotlib.pyplot"),
    ("formats-in-files", "cli/planted.py", "import yaml"),
    ("formats-in-files", "robot/planted.py", "from pint import UnitRegistry"),
    ("formats-in-files", "report/planted.py", "import pydantic"),
    ("terminal-in-cli", "design/planted.py", "import typer"),
    ("terminal-in-cli", "report/planted.py", "def table():\n    from rich.table import Table"),
    ("layers", "design/planted.py", "import rr_opt.batch.run"),
    ("processes-in-batch", "design/planted.py", "import joblib"),
    ("processes-in-batch", "cli/planted.py", "from distributed import Client"),
    ("plain-robot", "robot/planted.py", "import casadi as ca"),
    ("plain-robot", "problem.py", "import casadi as ca"),
    ("proof-apart", "proof/planted.py", "import rr_opt.diagnose.verdict"),
    ("lab-apart", "lab/planted.py", "import rr_opt.motion.cycle"),
    ("lab-apart", "lab/planted.py", "import rr_opt.files.units"),
    ("engines-apart", "lab/planar/planted.py", "import rr_opt.lab.plant"),
    ("engines-apart", "lab/planar/planted.py", "import rr_opt.lab.drive"),
    ("lab-unknown", "diagnose/planted.py", "import rr_opt.lab.rig"),
]


def lint_imports(root):
    """Exit code and text of import-linter on the copy of the package at `root`."""
    command = "from importlinter.cli import lint_imports_command as run; run()"
    run = subprocess.run(
        [sys.executable, "-c", command, "--no-cache", "--config", root / "pyproject.toml"],
        cwd=root / "src",
        env={**os.environ, "PYTHONPATH": str(root / "src"), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    return run.returncode, run.stdout + run.stderr


@pytest.fixture
def tree(tmp_path):
    """A copy of the package and its contracts, free to be spoiled."""
    shutil.copytree(
        ROOT / "src" / "rr_opt",
        tmp_path / "src" / "rr_opt",
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    return tmp_path


def test_the_package_keeps_them(tree):
    code, text = lint_imports(tree)
    assert code == 0, text
    assert f"{len(CONTRACTS)} kept, 0 broken" in text


@pytest.mark.parametrize(("contract", "file", "line"), PLANTED)
def test_a_planted_import_breaks(tree, contract, file, line):
    path = tree / "src" / "rr_opt" / file
    old = path.read_text(encoding="utf-8") if path.exists() else '"""Planted."""\n'
    path.write_text(f"{old}\n{line}\n", encoding="utf-8")
    code, text = lint_imports(tree)
    assert code == 1, text
    assert f"{CONTRACTS[contract]} BROKEN" in text


def test_a_package_without_a_layer_breaks(tree):
    (tree / "src" / "rr_opt" / "unplaced.py").write_text('"""Planted."""\n', encoding="utf-8")
    code, text = lint_imports(tree)
    assert code == 1, text
    assert f"{CONTRACTS['layers']} BROKEN" in text
    assert "- rr_opt.unplaced" in text


def test_no_contract_is_left_out():
    assert {contract for contract, _, _ in PLANTED} == set(CONTRACTS)


def test_every_folder_of_code_is_seen():
    """A folder without __init__.py would be passed over by the linter and by the installer."""
    folders = {path.parent for path in (ROOT / "src" / "rr_opt").rglob("*.py")}
    assert [str(folder) for folder in folders if not (folder / "__init__.py").exists()] == []
