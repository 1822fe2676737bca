"""A remade plan as a job folder: the same files as of any plan, the pattern copied."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from foldmill import CreasePattern, Fold
from foldmill.exchange import fold as fold_file
from foldmill_fabricate import folder
from foldmill_fabricate.choosing import fit_on_record
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.names import PATTERN
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plotter.ledger import Ledger
from foldmill_fabricate.profiles import Style
from foldmill_fabricate.remaking.make import remake
from foldmill_fabricate.remaking.words import Fate, read_spoken
from foldmill_fabricate.sending import open_job
from foldmill_fabricate.writers import usual_formats


def write_remake(
    plan: Plan, origin: Path, output: Path, formats: Sequence[str], style: Style | None = None
) -> Plan:
    """Write a remade plan into a folder of its own; return it with its programs named.

    origin : the folder that the sheet was begun from. Raises CannotPlan where both are one, for
    what the ledger knows of the sheet would be lost.
    """
    if origin.resolve() == output.resolve():
        raise CannotPlan(
            f"{output} is the folder that the sheet was begun from; write the rest into another."
        )
    if plan.whole.source is None:
        fold = fold_file.read((origin / PATTERN).read_text("utf-8"), PATTERN)
    else:
        fold = Fold(CreasePattern.from_lines([], [], [], []))
    return folder.write(fold, plan, output, formats, style)


def plan_rest(
    ledger: Ledger,
    sheet: str,
    origin: Path,
    output: Path,
    doubtful: Sequence[str] = (),
    half: Sequence[str] = (),
    formats: Callable[[Machine], Sequence[str]] = usual_formats,
) -> Plan:
    """Plan what the ledger says is missing on a sheet, write it into a folder, return the plan.

    origin : the folder that the sheet was begun from; it is proved again, for nothing is planned
    from an edited one. doubtful, half : what a person says, as ``read_spoken`` reads it. formats :
    of a machine. Raises CannotSend and CannotPlan.
    """
    job = open_job(origin)
    said = [read_spoken(each) for each in doubtful]
    said += [read_spoken(each, Fate.HALF) for each in half]
    fit = fit_on_record(ledger, sheet, job.plan)
    planned = remake(job.plan, ledger.sheet(sheet), said, fit)
    return write_remake(planned, origin, output, formats(planned.machine))
