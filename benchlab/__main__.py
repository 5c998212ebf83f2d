"""`python -m benchlab` and the `benchlab` command."""

from __future__ import annotations


def main() -> None:
    import signal
    import sys

    from benchlab.cli.app import run

    # Asked to end, it ends as by Ctrl-C: temporary files and locks are cleared away.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    run()


if __name__ == "__main__":
    main()
