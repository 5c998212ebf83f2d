"""One design from the options of a command."""

from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from benchlab.actuator import ShellDesign
from benchlab.cli.design_options import Design, design_options
from benchlab.errors import UsageError
from benchlab.io.design_file import write_design


@click.command()
@design_options
@click.option("--out", help="Where to.")
def made(design: ShellDesign, out: str | None) -> None:
    click.echo(f"{design!r} {out}")


@click.command()
@click.argument("design", type=Design())
def taken(design: ShellDesign) -> None:
    click.echo(repr(design))


def call(command: click.Command, *arguments: str) -> str:
    done = CliRunner().invoke(command, arguments, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.output.strip()


def test_numbers_make_a_design() -> None:
    assert call(made, "--tw-mm", "3", "--slw-mm", "10", "--out", "x") == f"{ShellDesign(10.0, 3.0)!r} x"
    every = ["--tw-mm", "3", "--slw-mm", "10", "--fw-mm", "1.5", "--perimeter-mm", "50", "--length-mm", "99"]
    assert call(made, *every) == f"{ShellDesign(10.0, 3.0, 1.5, 50.0, 99.0)!r} None"


def test_a_file_or_name_makes_a_design_and_numbers_replace_its_own(tmp_path: Path) -> None:
    write_design(tmp_path / "a.yaml", ShellDesign(12, 4, 2.5, 44, 150))
    assert call(made, "--design", str(tmp_path / "a.yaml")) == f"{ShellDesign(12.0, 4.0, 2.5, 44.0, 150.0)!r} None"
    assert call(made, "--design", "tw3_slw10", "--slw-mm", "5") == f"{ShellDesign(5.0, 3.0)!r} None"
    assert call(taken, "tw3_slw10") == repr(ShellDesign(10.0, 3.0))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], ["--tw-mm and --slw-mm are missing", "--design"]),
        (["--tw-mm", "3"], ["--slw-mm is missing"]),
        (["--slw-mm", "10", "--fw-mm", "2"], ["--tw-mm is missing"]),
        (["--tw-mm", "3", "--slw-mm", "40"], ["(slw) is 40"]),
        (["--design", "tw3_slw10", "--perimeter-mm", "10"], ["(slw) is 10", "perimeter_mm of 10"]),
        (["--design", "nothing.yaml"], ["nothing.yaml", "tw3_slw10"]),
    ],
)
def test_what_makes_no_design(arguments: list[str], words: list[str]) -> None:
    with pytest.raises(UsageError) as caught:
        CliRunner().invoke(made, arguments, catch_exceptions=False, standalone_mode=False)
    for word in words:
        assert word in str(caught.value)


def test_help_explains_the_symbols() -> None:
    text = " ".join(call(made, "--help").split())
    for words in ("Window width tw", "Width slw of the strain-limiting strip", "Fabric width fw", "FILE|NAME", "MM"):
        assert words in text
    assert text.index("--tw-mm") < text.index("--design") < text.index("--out")
    assert "DESIGN" in call(taken, "--help")
