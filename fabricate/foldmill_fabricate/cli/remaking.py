"""What is missing on a sheet, planned; and a sheet drawn as it was cut."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from foldmill import FoldmillError
from foldmill_fabricate.cli.making import formats_for

if TYPE_CHECKING:
    from foldmill_fabricate.passes import Plan
    from foldmill_fabricate.plotter.ledger import Ledger, SheetRecord


def rest(
    ledger: Ledger,
    name: str,
    output: Path,
    doubtful: Sequence[str],
    half: Sequence[str],
    job: Path | None,
    to: str | None,
) -> Plan:
    """Plan what is missing on a sheet, write it into a folder, and return the plan."""
    from foldmill_fabricate import remaking

    path = _folder(ledger, ledger.sheet(name), job)
    return remaking.plan_rest(
        ledger,
        name,
        path,
        output,
        doubtful,
        half,
        formats=lambda machine: formats_for(to, machine),
    )


def draw(ledger: Ledger, name: str, output: Path, job: Path | None) -> None:
    """Draw both faces of a sheet as its record says."""
    from foldmill_fabricate.files import write_whole
    from foldmill_fabricate.pictures.as_cut import as_cut_picture
    from foldmill_fabricate.verify import read_folder

    if output.suffix.lower() != ".png":
        raise FoldmillError(f"--output {output}: a sheet as cut is drawn as a PNG; name one.")
    sheet = ledger.sheet(name)
    files = read_folder(_folder(ledger, sheet, job))
    write_whole(output, as_cut_picture(files.plan, files.programs, sheet))


def _folder(ledger: Ledger, sheet: SheetRecord, job: Path | None) -> Path:
    """Return the folder that a sheet was begun from."""
    known = ledger.origin(sheet.id).folder
    if job is None and not known:
        raise FoldmillError(
            f"The ledger does not know from which folder sheet {sheet.id} was begun: name it with "
            "--job DIR."
        )
    return job or Path(known)
