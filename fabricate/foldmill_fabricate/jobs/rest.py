"""Plan what is missing on a sheet of a job, in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

from foldmill.errors import FoldmillError
from foldmill_fabricate import remaking
from foldmill_fabricate.beside import step_aside
from foldmill_fabricate.choosing import marks_on_record
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.jobs.places import Places
from foldmill_fabricate.jobs.values import Rest
from foldmill_fabricate.marks import fit_marks
from foldmill_fabricate.plotter.ledger import Ledger
from foldmill_fabricate.sending import open_job

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
    command = [sys.executable, "-m", "foldmill_fabricate.jobs.rest"]
    try:
        done = subprocess.run(
            command,
            input=json.dumps(order).encode(),
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=_PATIENCE,
            check=False,
        )
        refused = json.loads(done.stdout)["refused"]
    except (subprocess.TimeoutExpired, ValueError):
        raise CannotPlan(f"Planning the rest of sheet {sheet} ended without a result.") from None
    if refused:
        raise CannotPlan(refused)


def plan_rest(places: Places, origin: Path, folder: Path, sheet: str, said: Rest) -> None:
    """Plan what is missing on a sheet into a folder, in this process; raises FoldmillError."""
    ledger = Ledger(places.ledger)
    try:
        job = open_job(origin)  # proved again: nothing is planned from an edited folder
        marks = marks_on_record(ledger, sheet, job.plan)
        spoken = [remaking.read_spoken(each) for each in said.doubtful]
        spoken += [remaking.read_spoken(each, remaking.Fate.HALF) for each in said.half]
        fit = fit_marks(job.plan, marks).fit if marks else None
        planned = remaking.remake(job.plan, ledger.sheet(sheet), spoken, fit)
        formats = ["svg", "dxf", planned.machine.language]
        remaking.write_remake(planned, origin, folder, formats)
    finally:
        ledger.close()


def main() -> None:
    """Plan what standard input says, and say on standard output how that ended."""
    step_aside()
    order = json.loads(sys.stdin.read())
    places = Places(Path(order["root"]), order["database"])
    said, refused = Rest.model_validate(order["said"]), ""
    try:
        plan_rest(places, Path(order["origin"]), Path(order["folder"]), order["sheet"], said)
    except FoldmillError as error:
        refused = str(error)
    sys.stdout.write(json.dumps({"refused": refused}))


if __name__ == "__main__":
    main()
