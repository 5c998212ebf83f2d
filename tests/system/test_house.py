"""The house rules, run by machine: import floors, lint, format, types, doctests, and commands that README knows."""

import re
import subprocess
import sys
from pathlib import Path

import click
import pytest

from benchlab.cli.app import cli

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "command",
    [
        ["-c", "from importlinter.cli import lint_imports_command; lint_imports_command()"],
        ["-m", "ruff", "check", "."],
        ["-m", "ruff", "format", "--check", "."],
        ["-m", "mypy"],
        ["-m", "pytest", "-n0", "-p", "no:cacheprovider", "--doctest-modules", "benchlab"],
    ],
    ids=["import-floors", "ruff", "format", "mypy", "doctests"],
)
def test_rule(command: list[str]) -> None:
    done = subprocess.run([sys.executable, *command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-4000:]


def commands(group: click.Group, path: str = "benchlab") -> list[tuple[str, click.Command]]:
    found: list[tuple[str, click.Command]] = []
    for name, command in group.commands.items():
        here = f"{path} {name}"
        found += commands(command, here) if isinstance(command, click.Group) else [(here, command)]
    return found


@pytest.mark.parametrize(("path", "command"), commands(cli), ids=lambda value: value if isinstance(value, str) else "")
def test_every_command_teaches_and_stands_in_readme(path: str, command: click.Command) -> None:
    assert path in README, f"{path} has no line in README.md"
    assert command.help and command.short_help
    for parameter in command.params:
        if isinstance(parameter, click.Option):
            assert parameter.help, f"{path} {parameter.name} has no help"


def test_every_option_with_a_unit_wears_it() -> None:
    for _, command in commands(cli):
        for parameter in command.params:
            for option in parameter.opts:
                if re.search(r"length|span|reference|square", option):
                    assert option.endswith(("-mm", "-px")), option


@pytest.mark.parametrize("page", ["README.md", *(f"docs/{path.name}" for path in (ROOT / "docs").glob("*.md"))])
def test_links_lead_to_something(page: str) -> None:
    for path in re.findall(r"\]\(((?!http)[^)#]+)\)", (ROOT / page).read_text(encoding="utf-8")):
        assert ((ROOT / page).parent / path).exists(), path


def test_readme_names_only_commands_that_exist() -> None:
    for line in re.findall(r"^\s*(benchlab [a-z-]+(?: [a-z-]+)?)", README, re.MULTILINE):
        known = [path for path, _ in commands(cli)]
        assert any(line.startswith(path) for path in known), line
