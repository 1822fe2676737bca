"""Where the ledger is: a file of this user's, or the database that is named for all of foldmill."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from sqlalchemy.engine import make_url
from sqlalchemy.exc import ArgumentError

DATABASE = "FOLDMILL_DATABASE"
"""Variable of the environment: an SQLAlchemy URL in place of files under the folder."""


def state_folder() -> Path:
    """Return the folder of what foldmill keeps of its work for this user; it need not exist.

    ``$XDG_STATE_HOME/foldmill``, on Windows under ``%LOCALAPPDATA%``, by default under
    ``~/.local/state``.
    """
    home = os.environ.get("LOCALAPPDATA" if sys.platform == "win32" else "XDG_STATE_HOME")
    return (Path(home) if home else Path.home() / ".local/state") / "foldmill"


def ledger_file() -> Path:
    """Return the file of this user's ledger; its folder need not exist."""
    return state_folder() / "ledger.sqlite"


def ledger_place() -> Path | str:
    """Return where sheets and jobs are kept: what ``FOLDMILL_DATABASE`` names, else a file."""
    return os.environ.get(DATABASE, "") or ledger_file()


def told(place: Path | str) -> str:
    """Return a place as it may be told: a password in it is no one's business."""
    try:
        return str(place) if isinstance(place, Path) else make_url(place).render_as_string()
    except ArgumentError:
        return "that FOLDMILL_DATABASE names"
