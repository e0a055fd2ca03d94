"""Every command and file that README.md shows is one that `make readme` runs or writes."""

import re
import subprocess
from pathlib import Path

import pytest

import rr_opt
from rr_opt.files.lint import lint_file
from tests.readme_commands import Commands, File, Script, blocks, missing, steps

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
STEPS = steps(README)
COMMANDS = [line for step in STEPS if isinstance(step, Commands) for line in step.lines]
FILES = [step for step in STEPS if isinstance(step, File)]


def dry_run(targets):
    """What `make TARGETS` would do."""
    return subprocess.run(
        ["make", "--dry-run", *targets], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout


def test_make_readme_runs_the_readme():
    assert "-m tests.readme_commands README.md docs/how-to-diagnose.md" in dry_run(["readme"])


def test_no_block_is_passed_over():
    # As one would be that is indented or left open.
    assert README.count("```") == 2 * len(blocks(README))


def test_python_is_run_and_uses_public_names():
    scripts = [step.text for step in STEPS if isinstance(step, Script)]
    assert scripts
    for text in scripts:
        names = re.findall(r"\brr\.(\w+)", text)
        assert [name for name in names if name not in rr_opt.__all__] == []


def test_set_up_and_tests_are_one_command_each():
    assert {"make run", "make test"} <= set(COMMANDS)


@pytest.mark.parametrize("command", [line for line in COMMANDS if line.startswith("make")])
def test_the_make_target_exists(command):
    dry_run(command.split()[1:])


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_the_file_shown_is_right(file, tmp_path):
    for each in FILES:
        (tmp_path / each.name).write_text(each.text, encoding="utf-8")
    assert lint_file(tmp_path / file.name) == []


@pytest.mark.parametrize(
    "text",
    [
        "```sh\nrm -rf results\n```\n",
        "```ruby\nputs 1\n```\n",
        "```\nrr-opt sweep\n```\n",
        "```yaml\nh: 20 mm\n```\n",
        "```text\nout of nowhere\n```\n",
    ],
)
def test_a_block_that_would_not_be_run_is_refused(text):
    with pytest.raises(ValueError, match="; got"):
        steps(text)


def test_printed_lines_are_found_in_order():
    printed = "speed  1.2345 m/s\nfiles  out\n"
    assert missing(("speed 1.2346 m/s", "files out"), printed) is None
    assert missing(("speed 1.3 m/s",), printed) == "speed 1.3 m/s"
    assert missing(("files out", "speed 1.2345 m/s"), printed) == "speed 1.2345 m/s"
