"""`benchlab sample-data`."""

from __future__ import annotations

from pathlib import Path

import click


@click.command(short_help="Draw the sample clips, of known truth.")
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path("sample_data"), show_default=True, help="Folder to write to."
)
@click.option("--seed", type=int, default=1, show_default=True, help="Of the random numbers.")
def sample_data(out: Path, seed: int) -> None:
    """Draw the five published designs, five samples each, as short clips whose true angle is known, with their tables.

    The clips are drawn, not filmed: their final angles follow the published means and standard deviations.
    """
    from benchlab.cli.progress import progress
    from benchlab.workflows.sample_data import make_sample_data

    with progress("drawing") as report:
        written = make_sample_data(out, seed, report)
    click.echo(f"wrote {len(written)} files to {out}", err=True)
