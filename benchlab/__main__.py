"""`python -m benchlab` and the `benchlab` command."""

from __future__ import annotations


def main() -> None:
    from benchlab.cli.app import run

    run()


if __name__ == "__main__":
    main()
