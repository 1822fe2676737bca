"""Plan what is missing on a sheet of a job, in a process of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from foldmill_fabricate import remaking
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.jobs.elsewhere import Late, Silent, done, serve
from foldmill_fabricate.jobs.places import Places
from foldmill_fabricate.jobs.values import Rest
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.ledger import Ledger
from foldmill_fabricate.writers import require_writer, usual_formats

_PATIENCE = 3600.0
"""s after which planning is given up."""


def plan_rest_elsewhere(places: Places, origin: Path, folder: Path, sheet: str, said: Rest) -> None:
    """Have another process plan what is missing; raises CannotPlan with its sentence.

    origin : the folder that the sheet was begun from; folder : where the rest is written.
    """
    order = {
        "root": str(places.root),
        "database": places.database,
        "origin": str(origin),
        "folder": str(folder),
        "sheet": sheet,
        "said": said.model_dump(),
    }
    try:
        refused = done("foldmill_fabricate.jobs.rest", order, patience=_PATIENCE)["refused"]
    except (Late, Silent):
        raise CannotPlan(f"Planning the rest of sheet {sheet} ended without a result.") from None
    if refused:
        raise CannotPlan(refused)


def _planned(order: dict[str, Any]) -> dict[str, str]:
    """Plan what is missing on a sheet into a folder, in this process; raises FoldmillError."""
    said = Rest.model_validate(order["said"])
    ledger = Ledger(Places(Path(order["root"]), order["database"]).ledger)
    origin, folder = Path(order["origin"]), Path(order["folder"])
    try:
        remaking.plan_rest(
            ledger, order["sheet"], origin, folder, said.doubtful, said.half, _formats
        )
    finally:
        ledger.close()
    return {}


def _formats(machine: Machine) -> list[str]:
    """Return the formats of a job's folder; raises CannotPlan where none of them is a program."""
    require_writer(machine)
    return usual_formats(machine)


if __name__ == "__main__":
    serve(_planned)
