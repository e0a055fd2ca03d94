"""The source distribution is enough to test and build; its wheel runs from any folder."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
LEFT_OUT = (".ci", ".github", ".gitignore")
TEMPORARY = shutil.ignore_patterns(
    *(".git", ".venv*", "out", "build", "dist", "*.egg-info", "__pycache__", ".*_cache"),
    *(".hypothesis",),
)


def tracked() -> set[str]:
    """The files of the project, as version control has them."""
    done = subprocess.run(
        ("git", "ls-files", "-z"), cwd=ROOT, capture_output=True, text=True, check=False
    )
    if done.returncode:
        pytest.skip("not a checkout")
    names = {name for name in done.stdout.split("\0") if name and (ROOT / name).exists()}
    return {name for name in names if Path(name).parts[0] not in LEFT_OUT}


def built(kind: str, source: Path, folder: Path) -> Path:
    """What setuptools builds, as pip would ask it to."""
    code = f"from setuptools import build_meta; print(build_meta.build_{kind}({str(folder)!r}))"
    done = subprocess.run(
        (sys.executable, "-W", "ignore", "-c", code),
        cwd=source, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    return folder / done.stdout.split()[-1]


@pytest.fixture(scope="module")
def distributions(tmp_path_factory):
    """The source distribution, what is in it, and the wheel that is built from that."""
    folder = tmp_path_factory.mktemp("dist")
    shutil.copytree(ROOT, folder / "copy", ignore=TEMPORARY)
    sdist = built("sdist", folder / "copy", folder)
    with tarfile.open(sdist) as archive:
        archive.extractall(folder / "unpacked", filter="data")
    (source,) = (folder / "unpacked").iterdir()
    return sdist, source, built("wheel", source, folder)


def test_the_source_distribution_has_every_file(distributions):
    _, source, _ = distributions
    there = {path.relative_to(source).as_posix() for path in source.rglob("*") if path.is_file()}
    there = {name for name in there if not name.startswith("build/")}  # of the wheel
    assert tracked() - there == set()
    assert {name for name in there - tracked() if ".egg-info" not in name} <= {
        "PKG-INFO", "setup.cfg",
    }  # fmt: skip


def test_the_wheel_has_every_file_of_the_packages_and_no_other(distributions):
    *_, wheel = distributions
    there = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    wanted = {name.removeprefix("src/") for name in tracked() if name.startswith("src/")}
    assert there == wanted


def test_the_wheel_runs_from_any_folder(distributions, tmp_path):
    *_, wheel = distributions
    place = tmp_path / "site"
    install = ("-m", "pip", "install", "-qq", "--no-deps", "--no-index", "--target", str(place))
    subprocess.run((sys.executable, *install, str(wheel)), check=True)
    assert (place / "bin" / "rr-opt").stat().st_mode & 0o100
    code = (
        f"import sys; sys.path.insert(0, {str(place)!r}); import rr_opt, rr_lab, rr_paper; "
        f"found = [one.__file__ for one in (rr_opt, rr_lab, rr_paper)]; "
        f"assert all(one.startswith({str(place)!r}) for one in found), found; "
        "from rr_opt.cli.entry import main; main()"
    )
    for verb, shown in (
        (("--help",), "reproduce"),
        (("maximize-speed", "--out", "found"), "report.html"),
        (("init", "experiment", "--out", "mine"), "experiment.yaml"),
        (("inspect", "mine", "--out", "seen"), "report.html"),
        (("record", "--engine", "planar", "--seconds", "3", "--out", "made"), "7 recordings"),
    ):
        done = subprocess.run(
            (sys.executable, "-c", code, *verb),
            cwd=tmp_path, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr[-2000:]
        assert shown in done.stdout
    assert (tmp_path / "found" / "report.html").stat().st_size > 10_000


def test_the_recipe_asks_for_what_the_project_does():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    text = (ROOT / "packaging" / "recipe.yaml").read_text()
    recipe = yaml.safe_load(text)
    run = {line.replace("-base", "").replace(" ", "") for line in recipe["requirements"]["run"][1:]}
    assert run == set(project["dependencies"])
    from rr_opt.version import __version__

    assert recipe["context"]["version"] == __version__
    assert project["requires-python"] == f">={recipe['context']['python_min']}"
    matrix = yaml.safe_load((ROOT / ".github" / "workflows" / "check.yml").read_text())
    versions = matrix["jobs"]["check"]["strategy"]["matrix"]["python"]
    named = {line.split(" :: ")[-1] for line in project["classifiers"] if ":: 3." in line}
    assert set(versions) == named
