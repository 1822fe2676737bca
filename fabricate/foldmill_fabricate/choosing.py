"""Which sheet is worked on: a new one, or one that was begun and lies beside others."""

from __future__ import annotations

from collections.abc import Sequence

from foldmill_fabricate.marks import fit_marks
from foldmill_fabricate.passes import XY, Face, Fit, Plan, ProgramFile, Remakes
from foldmill_fabricate.plotter.errors import LedgerRefused
from foldmill_fabricate.plotter.languages import made_ready
from foldmill_fabricate.plotter.ledger import GoesOn, Ledger, Program, SheetRecord, State
from foldmill_fabricate.sending import Job

NEW = "new"
"""In place of a sheet's id: begin another one."""


def choose_sheet(ledger: Ledger, job: Job, faces: Sequence[Face], sheet: str) -> SheetRecord:
    """Return the sheet to work on; raises LedgerRefused where that is not certain."""
    if job.plan.remakes is not None:
        return _gone_on_with(ledger, job, job.plan.remakes)
    if sheet and sheet.lower() != NEW:
        return _named(ledger, job, sheet)
    if not sheet:
        begun = ledger.open_sheets(job.id)
        waiting = [one for one in begun if _waits_for(one, faces)]
        if len(begun) == len(waiting) == 1:
            return waiting[0]
        if begun:
            told = " ".join(f"Sheet {one.id}: {_told(one)}." for one in begun)
            raise LedgerRefused(
                f"This job is begun already. {told} Name the sheet that lies on the machine, "
                f"such as --sheet {begun[0].id}, or begin another with --sheet new."
            )
        _refuse_planned_again(ledger, job)
    return _laid(ledger, job)


def marks_on_record(ledger: Ledger, sheet: str, plan: Plan) -> tuple[XY, ...]:
    """Return the marks last measured on a sheet, or while it went by another id; carrier mm."""
    told = [one.told["marks"] for one in ledger.answers(sheet) if "marks" in one.told]
    if told:
        return tuple((float(x), float(y)) for x, y in told[-1])
    before = plan.remakes
    return marks_on_record(ledger, before.sheet, before.origin) if before else ()


def fit_on_record(ledger: Ledger, sheet: str, plan: Plan) -> Fit | None:
    """Return how the reverse of a sheet lay, where its marks were measured."""
    marks = marks_on_record(ledger, sheet, plan)
    return fit_marks(plan, marks).fit if marks else None


def _laid(ledger: Ledger, job: Job, goes_on: GoesOn | None = None) -> SheetRecord:
    return ledger.lay(
        job.id,
        [_program(job, part) for part in job.plan.programs],
        title=job.plan.title,
        machine=job.plan.machine.slug,
        material=job.plan.material.slug,
        folder=str(job.path.resolve()),
        goes_on=goes_on,
    )


def _gone_on_with(ledger: Ledger, job: Job, remakes: Remakes) -> SheetRecord:
    """Return what goes on with a sheet: there is one such sheet only, and never another."""
    found = ledger.successor(remakes.sheet)
    if found is None:
        return _laid(ledger, job, GoesOn(remakes.sheet, remakes.record_sha256))
    if found.job != job.id:
        raise LedgerRefused(
            f"The rest of sheet {remakes.sheet} was begun already from another plan, as "
            f"{found.id}: {_told(found)}. Go on with that one, or plan what is left of it with "
            f"foldmill sheets {found.id} --remake."
        )
    if not found.is_open:
        raise LedgerRefused(
            f"The rest of sheet {remakes.sheet} was made already, as {found.id}: {_told(found)}. "
            "Nothing of it is cut again."
        )
    return found


def _named(ledger: Ledger, job: Job, sheet: str) -> SheetRecord:
    found = ledger.sheet(sheet)
    if found.job != job.id:
        raise LedgerRefused(
            f"Sheet {found.id} is one of {found.title or 'another job'}, planned otherwise: its "
            "programs are not these: name the folder it was begun from; if that was planned again, "
            "plan it as it was before, or give the sheet up with foldmill sheets "
            f"{found.id} --spoiled."
        )
    return found


def _refuse_planned_again(ledger: Ledger, job: Job) -> None:
    """Refuse where a sheet of the same name lies half done that another plan was begun on."""
    plan = job.plan
    same = (plan.title, plan.machine.slug, plan.material.slug)
    left = [one for one in ledger.open_sheets() if (one.title, one.machine, one.material) == same]
    if left:
        told = " ".join(f"Sheet {one.id}: {_told(one)}." for one in left)
        raise LedgerRefused(
            f"{plan.title or 'This job'} was planned again since a sheet of it was begun. {told} "
            "The new programs do not go on on that sheet: plan as before to finish it, or give it "
            f"up with foldmill sheets {left[0].id} --spoiled; or send with --sheet new for another."
        )


def _waits_for(sheet: SheetRecord, faces: Sequence[Face]) -> bool:
    """Tell whether all that is asked for is still to be begun, and nothing else is in doubt."""
    asked = [record for record in sheet.records if record.program.face in faces]
    settled = {State.READY, State.DONE}
    return all(record.state is State.READY for record in asked) and all(
        record.state in settled for record in sheet.records
    )


def _told(sheet: SheetRecord) -> str:
    return ", ".join(f"{record.program.name} {record.state.value}" for record in sheet.records)


def _program(job: Job, part: ProgramFile) -> Program:
    machine = job.plan.machine
    strokes = made_ready(job.programs[part.name], machine).strokes
    return Program(part.name, part.face, part.sha256, strokes)
