"""Where this user's service is reached; read by those who want to talk to it."""

from __future__ import annotations

import json
import os
from pathlib import Path

from foldmill_fabricate.plotter.ledger import ledger_file

REACHED = "reached.json"


def state_folder() -> Path:
    """Return where this user's service keeps its things: beside the ledger."""
    return ledger_file().parent / "service"


def reached(folder: Path | None = None) -> str | None:
    """Return the address of the service that runs on this folder; None where none does."""
    try:
        said = json.loads(((folder or state_folder()) / REACHED).read_bytes())
        os.kill(said["pid"], 0)
    except PermissionError:
        return str(said["url"])  # another user's, and alive
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return str(said["url"])
