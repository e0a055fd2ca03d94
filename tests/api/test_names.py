"""`import rr_opt` loads nothing heavy, and every public name is there, typed and documented."""

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import rr_opt as rr

NAMES = [name for name in rr.__all__ if name != "__version__"]


def test_a_plain_import_is_light():
    heavy = ("casadi", "numpy", "matplotlib", "scipy", "pydantic", "typer")
    program = f"import sys, rr_opt; assert not [n for n in {heavy} if n in sys.modules]"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", NAMES)
def test_a_name_is_there_with_a_docstring_and_types(name):
    found = getattr(rr, name)
    assert name in dir(rr)
    assert inspect.getdoc(found)
    if inspect.isfunction(found):
        signature = inspect.signature(found)
        assert signature.return_annotation is not inspect.Signature.empty
        assert all(one.annotation is not one.empty for one in signature.parameters.values())


def test_type_checkers_see_the_same_names():
    tree = ast.parse(Path(str(rr.__file__)).read_text(encoding="utf-8"))
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    typed = {alias.asname for node in imports for alias in node.names if alias.asname}
    assert typed == set(NAMES)


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="maximise_speed"):
        rr.maximise_speed  # noqa: B018


def test_the_page_of_the_library_shows_each_of_them_once_and_no_other():
    page = (Path(__file__).parents[2] / "docs" / "library.md").read_text(encoding="utf-8")
    shown = sorted(line for line in page.splitlines() if line.startswith("::: "))
    public = {f"::: rr_opt.{rr._MODULE_OF[name]}.{name}" for name in NAMES}
    assert shown == sorted({*public, "::: rr_opt.results.result.Result"})
