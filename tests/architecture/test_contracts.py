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
    ("layers", "rr_opt/model/planted.py", "import rr_opt.motion.dynamics"),
    ("layers", "rr_opt/mechanics/planted.py", "import rr_opt.motion.steady_cycle"),
    ("layers", "rr_opt/effects/planted.py", "import rr_opt.motion.dynamics"),
    ("layers", "rr_opt/files/planted.py", "import rr_opt.motion.steady_cycle"),
    ("layers", "rr_opt/motion/planted.py", "import rr_opt.files.lint"),
    ("layers", "rr_opt/design/planted.py", "import rr_opt.cli.main"),
    ("layers", "rr_opt/design/planted.py", "import rr_opt.batch.run"),
    ("layers", "rr_opt/results/planted.py", "import rr_opt.api.optimise"),
    ("layers", "rr_opt/documents/planted.py", "import rr_opt.results.fastest"),
    ("layers", "rr_opt/api/planted.py", "import rr_opt.cli.main"),
    ("layers", "rr_opt/sysid/planted.py", "import rr_opt.machines.racer.racer"),
    ("packages", "rr_opt/results/planted.py", "import rr_lab.rig"),
    ("packages", "rr_opt/results/planted.py", "import rr_paper.publication"),
    ("lab-layers", "rr_lab/rig.py", "import rr_lab.case"),
    ("check-apart-from-design", "rr_opt/verify/planted.py", "import rr_opt.design.solve"),
    ("check-apart-from-design", "rr_opt/design/planted.py", "import rr_opt.verify.replay"),
    ("sweep-apart-from-motion", "rr_opt/verify/sweep.py", "import rr_opt.motion.steady_cycle"),
    ("machine-free", "rr_opt/sysid/planted.py", "import rr_opt.effects"),
    ("figures-in-report", "rr_opt/verify/planted.py", "import matplotlib.pyplot"),
    ("formats-in-files", "rr_opt/cli/planted.py", "import yaml"),
    ("formats-in-files", "rr_opt/model/planted.py", "from pint import UnitRegistry"),
    ("formats-in-files", "rr_opt/results/planted.py", "import pydantic"),
    ("terminal-in-cli", "rr_opt/design/planted.py", "import typer"),
    ("terminal-in-cli", "rr_lab/report/planted.py", "def f():\n    from rich.table import Table"),
    ("verbs-call-the-library", "rr_opt/cli/planted.py", "import rr_opt.motion.rollout"),
    ("verbs-call-the-library", "rr_opt/cli/verbs.py", "import rr_opt.verify.sweep"),
    ("processes-in-batch", "rr_opt/design/planted.py", "import joblib"),
    ("processes-in-batch", "rr_opt/cli/planted.py", "from distributed import Client"),
    ("plain-model", "rr_opt/model/robot.py", "import casadi as ca"),
    ("trial-apart", "rr_lab/trial/planted.py", "import rr_opt.sysid.selection"),
    ("lab-apart", "rr_lab/rig.py", "import rr_opt.motion.steady_cycle"),
    ("lab-apart", "rr_lab/random_case.py", "import rr_opt.files.lint"),
    ("engines-apart", "rr_lab/planar/planted.py", "import rr_lab.mujoco.plant"),
]
PACKAGES = ("rr_opt", "rr_lab", "rr_paper")


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
    for package in PACKAGES:
        shutil.copytree(
            ROOT / "src" / package,
            tmp_path / "src" / package,
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
    path = tree / "src" / file
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
    folders = {path.parent for path in (ROOT / "src").rglob("*.py")}
    assert [str(folder) for folder in folders if not (folder / "__init__.py").exists()] == []
