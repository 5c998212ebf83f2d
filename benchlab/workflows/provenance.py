"""Who made a result, when, with which program and versions."""

from __future__ import annotations

import platform
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import benchlab


def made_by(*libraries: str) -> dict[str, Any]:
    """When, by which command line, and with which versions of benchlab, Python and these libraries, where they are loaded.

    >>> sorted(made_by("numpy"))
    ['argv', 'created', 'git', 'versions']
    """
    versions = {"benchlab": benchlab.__version__, "python": platform.python_version()}
    for name in libraries:
        versions[name] = getattr(sys.modules.get(name), "__version__", "not loaded")
    return {
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "argv": sys.argv,
        "versions": versions,
        "git": _git_hash(),
    }


def _git_hash() -> str | None:
    """The commit of a source checkout that this code runs from, if it does."""
    top = Path(benchlab.__file__).parent.parent
    if not (top / ".git").exists():
        return None
    try:
        found = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=top, capture_output=True, text=True, timeout=5, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return found.stdout.strip() or None
