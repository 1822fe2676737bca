"""Send a proved job program by program, keeping the ledger, and asking the operator.

A program that is done is never sent again; one that ended before its end goes on only on the
operator's word.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.operators import Operator
from foldmill_fabricate.passes import Face, ProgramFile, SetUp
from foldmill_fabricate.plotter import link, resume, sender
from foldmill_fabricate.plotter.errors import Fenced, LedgerRefused
from foldmill_fabricate.plotter.languages import made_ready, spoken
from foldmill_fabricate.plotter.ledger import (
    Ledger,
    Program,
    Record,
    Run,
    Said,
    SheetRecord,
    State,
    Word,
    account,
    ledger_file,
)
from foldmill_fabricate.plotter.lock import held
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.sender import Delivery, Progress, Status
from foldmill_fabricate.plotter.transcript import recorded
from foldmill_fabricate.sending import Job

NEW = "new"
"""In place of a sheet's id: begin another one."""
Tell = Callable[[ProgramFile, Progress], None]
_ENDS = {
    Status.EXECUTED: State.DONE,
    Status.UNCONFIRMED: State.UNCONFIRMED,
    Status.FAULT: State.INTERRUPTED,
}


@dataclass(frozen=True)
class Sent:
    """One program, and how its delivery ended."""

    sheet: str
    program: ProgramFile
    delivery: Delivery
    state: State
    """What the ledger says of it now."""


def own_ledger(url: str) -> Ledger:
    """Return the ledger that a device's sheets are in.

    A simulator in this process ends with it, and so do its sheets: they are kept in memory.
    """
    return Ledger("sqlite://" if url.startswith("sim://") else ledger_file())


def send_job(
    job: Job,
    url: str,
    operator: Operator,
    faces: Sequence[Face] = (Face.FRONT, Face.REVERSE),
    tell: Tell = lambda _part, _progress: None,
    ledger: Ledger | None = None,
    sheet: str = "",
    transcript: Path | None = None,
) -> Iterator[Sent]:
    """Send the programs of these faces in order of work, yielding after each.

    url : any address pyserial opens, or ``sim://NAME``. tell : hears of every instruction.
    ledger : by default the user's own. sheet : the id of a sheet that is begun, or NEW; by default
    the one that waits for these faces, else a new one. transcript : a file for what goes over the
    wire. Raises CannotSend where the operator says
    no, LedgerRefused where the sheet is in doubt, PlotterError where the line fails. It ends early
    after a program that is not done.
    """
    book = ledger or own_ledger(url)
    with (
        held(url) as device,
        link.open_port(url, job.plan.machine) as opened,
        recorded(opened, link.clock_of(opened), transcript) as port,
    ):
        laid = choose_sheet(book, job, faces, sheet)  # before anybody loads a sheet
        for number, part in enumerate(job.plan.programs):
            if part.face not in faces:
                continue
            work = _Work(job, part, book, laid.id, number)
            if not work.settle(port, operator):
                continue
            work.pass_gates(operator)
            delivery = work.send(port, device, partial(tell, part))
            state = work.end(delivery, operator)
            yield Sent(laid.id, part, delivery, state)
            if state is not State.DONE:
                return


def choose_sheet(ledger: Ledger, job: Job, faces: Sequence[Face], sheet: str) -> SheetRecord:
    """Return the sheet to work on; raises LedgerRefused where that is not certain."""
    begun = ledger.open_sheets(job.id)
    if sheet and sheet.lower() != NEW:
        found = ledger.sheet(sheet)
        if found.job != job.id:
            raise LedgerRefused(
                f"Sheet {found.id} is one of {found.title or 'another job'}, planned otherwise; "
                "name the folder it was begun from."
            )
        return found
    waiting = [one for one in begun if _waits_for(one, faces)]
    if not sheet and len(begun) == len(waiting) == 1:
        return waiting[0]
    if begun and not sheet:
        told = " ".join(f"Sheet {one.id}: {_told(one)}." for one in begun)
        raise LedgerRefused(
            f"This job is begun already. {told} Name the sheet that lies on the machine, or say "
            "that it is a new one."
        )
    return ledger.lay(
        job.id,
        [_program(job, part) for part in job.plan.programs],
        title=job.plan.title,
        machine=job.plan.machine.slug,
        material=job.plan.material.slug,
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


@dataclass
class _Work:
    """One program of a sheet."""

    job: Job
    part: ProgramFile
    ledger: Ledger
    sheet: str
    number: int
    run: Run | None = None

    def settle(self, port: Any, operator: Operator) -> bool:
        """Have what is in doubt decided; False where nothing is left to be sent."""
        record = self.ledger.recover(self.sheet, self.number)
        if record.state in {State.INTERRUPTED, State.UNCONFIRMED}:
            word = operator.decide(record, self._where(record, port))
            if word is None:
                raise LedgerRefused(
                    f"{record.program.name} of sheet {self.sheet} is {record.state.value}. "
                    f"{record.note} {account(record)} It goes on only on a person's word."
                )
            record = self.ledger.say(self.sheet, self.number, word)
        if record.state is State.SPOILED:
            raise CannotSend(f"Sheet {self.sheet} is given up; begin a new one.")
        return record.state is not State.DONE

    def _where(self, record: Record, port: Any) -> Start | None:
        """Return where the machine proves to stand."""
        last = record.runs[-1]
        if last.sent == last.acked:
            return Start(last.acked)  # nothing is in doubt
        place = sender.whereabouts(port, self.job.plan.machine)
        return place and resume.locate(self._job(), last.acked, last.sent, place)

    def _job(self) -> Any:
        machine = self.job.plan.machine
        return made_ready(self.job.programs[self.part.name], machine)

    def pass_gates(self, operator: Operator) -> None:
        """Have the operator do what is due before this program."""
        plan = self.job.plan
        setup = self._setup()
        if not all(operator.ready(gate, self.part.face, setup, plan) for gate in setup.gates):
            raise CannotSend(f"Stopped before {self.part.name}, as the operator said.")

    def _setup(self) -> SetUp:
        setups = {one.number: one for work in self.job.plan.passes for one in work.setups}
        return setups[self.part.setups[0]]

    def send(self, port: Any, device: str, tell: Callable[[Progress], None]) -> Delivery:
        """Deliver it; however that ends, the ledger knows."""
        plan, program = self.job.plan, self.job.programs[self.part.name]
        record = self.ledger.record(self.sheet, self.number)
        start = Start(record.first, record.vertex, record.overlap, self._again(record))
        self.run = self.ledger.claim(self.sheet, self.number, device)
        try:
            return sender.send(
                program, port, plan.machine, progress=tell, start=start, book=self.run
            )
        except Fenced:
            raise
        except BaseException as error:
            self.run.end(State.INTERRUPTED, str(error) or type(error).__name__)
            raise

    def _again(self, record: Record) -> tuple[int, ...]:
        """Return the lead-in that a blade needs which nobody knows how it points."""
        if not self.job.plan.machine.tools.host_offset:
            return ()
        machine = self.job.plan.machine
        return spoken(machine).lead_in(self._job(), record.first)

    def end(self, delivery: Delivery, operator: Operator) -> State:
        """Give the token back and say how the program stands.

        Where a machine can never answer, a person says whether it has finished. One that can, and
        did not confirm, may still be at work: opening the next program would discard what it holds.
        """
        assert self.run is not None
        state = _ENDS[delivery.status]
        self.run.end(state, delivery.fault)
        record = self.ledger.record(self.sheet, self.number)
        cannot_say = state is State.UNCONFIRMED and not self.job.plan.machine.serial.answers
        if cannot_say and operator.has_finished(record):
            return self.ledger.say(self.sheet, self.number, Said(Word.FINISHED)).state
        return state
