"""A pin can be installed on every Python that the project names, or says on which."""

from __future__ import annotations

import importlib.metadata
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet

ROOT = Path(__file__).parents[2]
CLASSIFIERS = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["classifiers"]
PYTHONS = [text.split()[-1] for text in CLASSIFIERS if text.startswith("Programming Language")]
INSTALLED = {dist.name: dist for dist in importlib.metadata.distributions()}


def section(name):
    """The requirements under a heading."""
    text = (ROOT / "requirements.lock").read_text().partition(f"# [{name}]\n")[2]
    return [Requirement(line) for line in text.partition("\n\n")[0].splitlines()]


def pins():
    """The requirements of run and dev, which are installed where tests run."""
    return [*section("run"), *section("dev")]


def test_what_is_measured_against_others_has_all_it_needs():
    assert {one.name for one in section("run")} <= {one.name for one in section("bench")}


@pytest.mark.parametrize("python", PYTHONS)
def test_pins_are_for_this_python(python):
    version = {"python_version": python, "python_full_version": f"{python}.0"}
    for pin in pins():
        if pin.name in INSTALLED and (not pin.marker or pin.marker.evaluate(version)):
            accepted = INSTALLED[pin.name].metadata.get("Requires-Python", "")
            assert SpecifierSet(accepted).contains(f"{python}.0"), f"{pin}: {accepted}"
