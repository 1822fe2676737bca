"""Send a proved job program by program, keeping the ledger, and asking the operator.

A program that is done is never sent again; one that ended before its end goes on only on the
operator's word. Before each the operator passes the gates that are due (``gates``), and a preset
that nobody has tried is tried in the waste first (``trials``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from foldmill_fabricate import gates, recovery, trials
from foldmill_fabricate.choosing import NEW, choose_sheet, marks_on_record
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.gates import Request
from foldmill_fabricate.operators import Operator, Verdict
from foldmill_fabricate.passes import Face, Gate, ProgramFile, SetUp
from foldmill_fabricate.plotter import link, sender
from foldmill_fabricate.plotter.errors import Fenced, LedgerRefused, Stopped
from foldmill_fabricate.plotter.holding import Holder
from foldmill_fabricate.plotter.ledger import (
    Ledger,
    Record,
    Run,
    Said,
    SheetRecord,
    State,
    Word,
    account,
    devices,
)
from foldmill_fabricate.plotter.ledger.alone import alone, alone_on, by_hand, own_ledger
from foldmill_fabricate.plotter.ledger.guarding import Lying, guarded
from foldmill_fabricate.plotter.sender import Delivery, Progress, Status
from foldmill_fabricate.plotter.transcript import recorded
from foldmill_fabricate.plotter.wish import Wish
from foldmill_fabricate.sending import Job

__all__ = ["NEW", "Sent", "Tell", "choose_sheet", "own_ledger", "send_job"]

Tell = Callable[[ProgramFile, Progress], None]
MARKS = "marks"
"""What the ledger calls an answer that belongs to no gate."""
_ENDS = {
    Status.EXECUTED: State.DONE,
    Status.ENDED: State.DONE,
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


def send_job(
    job: Job,
    url: str,
    operator: Operator,
    faces: Sequence[Face] = (Face.FRONT, Face.REVERSE),
    tell: Tell = lambda _part, _progress: None,
    ledger: Ledger | None = None,
    sheet: str = "",
    test_cut: bool = False,
    transcript: Path | None = None,
    wish: Wish | None = None,
    holder: Holder | None = None,
) -> Iterator[Sent]:
    """Send the programs of these faces in order of work, yielding after each.

    url : any address pyserial opens, or ``sim://NAME``. tell : hears of every instruction.
    ledger : by default the user's own. sheet : the id of a sheet that is begun, or NEW; by default
    the one that waits for these faces, else a new one. test_cut : cut one in the waste for each
    process without asking, whether the preset is tested or not. transcript : a file for what
    goes over the wire. wish : by which another thread pauses or stops it. holder : who is at work,
    as others are told. Raises CannotSend where the operator says no or answers what cannot be,
    LedgerRefused where the sheet is in doubt, PlotterError where the line fails, PortUnavailable
    where somebody else has it, Spoiled where the sheet is given up meanwhile. It ends early after a
    program that is not done.
    """
    book, who = ledger or own_ledger(url), holder or by_hand(f"send {job.path}")
    with (
        alone(url, who, book) as device,
        link.open_port(url, job.plan.machine) as opened,
        recorded(opened, link.clock_of(opened), transcript) as port,
    ):
        laid = choose_sheet(book, job, faces, sheet)  # before anybody loads a sheet
        with alone_on(laid.id, who, book):
            bench = _Bench(job, operator, book, laid, port, device, test_cut, wish)
            yield from _made(bench, faces, tell)


def _made(bench: _Bench, faces: Sequence[Face], tell: Tell) -> Iterator[Sent]:
    bench.find_fit()
    for number, part in enumerate(bench.job.plan.programs):
        if part.face in faces:
            sent = bench.make(number, part, partial(tell, part))
            yield from [sent] if sent else []
            if sent and sent.state is not State.DONE:
                return
    bench.finish()


class _Bench:
    """A machine, a sheet on it, and the operator beside it."""

    def __init__(
        self,
        job: Job,
        operator: Operator,
        ledger: Ledger,
        laid: SheetRecord,
        port: Any,
        device: str,
        test_cut: bool,
        wish: Wish | None,
    ) -> None:
        self.job, self.operator, self.ledger, self.sheet = job, operator, ledger, laid.id
        self.port, self.device, self.test_cut, self.wish = port, device, test_cut, wish
        self.marks_seen = bool(job.marks)  # on the sheet as it lies now
        self.returned = laid.is_begun
        """Whether somebody has worked on this sheet, and went away since."""
        self.worked = False
        """Whether anything was sent in this call."""

    def find_fit(self) -> None:
        """Keep the marks that were measured, or take those that were measured before."""
        if self.job.marks:
            self._keep_marks(self.job.marks)
            return
        if known := marks_on_record(self.ledger, self.sheet, self.job.plan):
            self.job = self.job.fitted(known)

    def _keep_marks(self, marks: Sequence[tuple[float, float]]) -> None:
        told = {"marks": [list(mark) for mark in marks]}
        self.ledger.answer(self.sheet, None, MARKS, told)

    def make(self, number: int, part: ProgramFile, tell: Callable[[Progress], None]) -> Sent | None:
        """Make one program of the sheet; None where nothing is left of it."""
        work = _Work(self, part, number)
        if not work.settle():
            return None
        work.pass_gates()
        work.try_presets()
        delivery = work.send(tell)
        self.worked, self.returned = True, False
        return Sent(self.sheet, part, delivery, work.end(delivery))

    def finish(self) -> None:
        """Have the sheet taken off where all of it is made."""
        if not self.worked or self.ledger.sheet(self.sheet).is_open:
            return
        last = self.job.plan.passes[-1]
        request = self.request(Gate.REMOVE, last.face, last.setups[-1])
        answer = self.operator.ready(request)
        if answer is not None:
            self.ledger.answer(self.sheet, None, Gate.REMOVE, answer.told, answer.who)

    def request(self, gate: Gate, face: Face, setup: SetUp) -> Request:
        """Return what the operator is asked for."""
        measured = [one.told.get("thickness") for one in self.ledger.answers(self.sheet)]
        known = [float(each) for each in measured if each is not None]
        return Request(
            gate,
            face,
            setup,
            self.job.plan,
            self.job.plan.written(self.sheet),
            known[-1] if known else None,
            self.marks_seen,
            self.job.path / f"flip-{self.sheet}.png" if gate is Gate.FLIP else None,
        )


class _Work:
    """One program of a sheet."""

    def __init__(self, bench: _Bench, part: ProgramFile, number: int) -> None:
        self.bench, self.part, self.number = bench, part, number
        self.ledger, self.sheet = bench.ledger, bench.sheet
        self.run: Run | None = None

    @property
    def record(self) -> Record:
        """How it stands."""
        return self.ledger.record(self.sheet, self.number)

    @property
    def setups(self) -> list[SetUp]:
        """Its set-ups, in order of work."""
        every = [one for work in self.bench.job.plan.passes for one in work.setups]
        return [one for one in every if one.number in self.part.setups]

    def settle(self) -> bool:
        """Have what is in doubt decided; False where nothing is left to be sent."""
        record = self.ledger.recover(self.sheet, self.number)
        if record.state in {State.INTERRUPTED, State.UNCONFIRMED}:
            place = recovery.standing(self.bench.job, self.part, record, self.bench.port)
            word = self.bench.operator.decide(record, place.start, place.told)
            if word is None:
                raise LedgerRefused(
                    f"{record.program.name} of sheet {self.sheet} is {record.state.value}. "
                    f"{record.note} {account(record)} It goes on only on a person's word."
                )
            recovery.refuse(self.bench.job, self.part, word)
            record = self.ledger.say(self.sheet, self.number, word, word.who)
        if record.state is State.SPOILED:
            raise CannotSend(f"Sheet {self.sheet} is given up; begin a new one.")
        return record.state is not State.DONE

    def pass_gates(self) -> None:
        """Have the operator do what is due before this program."""
        bench, setup = self.bench, self.setups[0]
        begun = bool(self.record.runs)
        wanted = gates.due(setup, bench.job.plan, returned=bench.returned, begun=begun)
        warning = self._warning()
        for gate in wanted:
            request = replace(bench.request(gate, self.part.face, setup), warning=warning)
            answer = bench.operator.ready(request)
            if answer is None:
                raise CannotSend(
                    f"Stopped before {self.part.name}, as the operator said. Send again to go on."
                )
            gates.check(request, answer)
            if answer.marks:
                bench.job, bench.marks_seen = bench.job.fitted(answer.marks), True
            self.ledger.answer(self.sheet, self.number, gate, answer.told, answer.who)
            warning = ""

    def _warning(self) -> str:
        """Say what may lie in the machine, where something broke off that nobody has spoken of."""
        left = self.ledger.broken_off(self.bench.device)
        if left is None or (left.sheet == self.sheet and not left.is_trial):
            return ""  # of this sheet's own programs it is asked anyway
        return recovery.half(self.bench.job.plan.machine)

    def try_presets(self) -> None:
        """Cut in the waste what nobody has tried, before anything of the part is cut so."""
        plan = self.bench.job.plan
        if self.record.runs or not trials.are_offered(plan):
            return
        for setup in self.setups:
            if trials.first_of_its_process(plan, setup):
                self._try(setup)

    def _try(self, setup: SetUp) -> None:
        bench = self.bench
        request = bench.request(Gate.TOOL, self.part.face, setup)
        asked = not bench.test_cut and not bench.job.plan.material.tested
        wanted = bench.test_cut or (asked and bench.operator.wants_test_cut(request))
        if asked and not wanted:
            declined = {"set-up": setup.name, "verdict": "not wanted"}
            self.ledger.answer(self.sheet, self.number, trials.JUDGED, declined, bench.operator.who)
        make = bench.job.trier or trials.trial_program
        while wanted:
            attempt = trials.begun(self.ledger.answers(self.sheet), setup)
            program = make(bench.job, self.part.face, setup, attempt)
            told = {"set-up": setup.name, "attempt": attempt + 1}
            self.ledger.answer(self.sheet, self.number, trials.BEGUN, told, bench.operator.who)
            self.ledger.on_device(self.sheet, self.number, devices.TRYING, bench.device)
            delivery = self._send_trial(program)
            if delivery.fault:
                raise CannotSend(f"The test cut for {setup.name} went wrong. {delivery.fault}")
            self.ledger.on_device(self.sheet, self.number, devices.TRIED, bench.device)
            verdict = bench.operator.judge(request)
            told = told | {"verdict": verdict.value}
            self.ledger.answer(self.sheet, self.number, trials.JUDGED, told, bench.operator.who)
            if verdict is Verdict.STOP:
                raise CannotSend(trials.BAD.format(setup.name))
            wanted = verdict is Verdict.AGAIN

    def _send_trial(self, program: bytes) -> Delivery:
        """Deliver a test cut, for as long as nobody gives the sheet up."""
        bench, lying = self.bench, Lying(self.ledger, self.sheet)
        if lost := lying.loss():
            raise lost
        try:
            with guarded(lying, bench.wish) as wish:
                return sender.send(program, bench.port, bench.job.plan.machine, wish=wish)
        except Stopped as error:
            if lost := lying.loss():
                raise type(lost)(f"{lost} {error}") from None
            raise

    def send(self, tell: Callable[[Progress], None]) -> Delivery:
        """Deliver it; however that ends, the ledger knows."""
        job = self.bench.job
        record = self.record
        start = recovery.start_of(job, self.part, record)
        self.run = self.ledger.claim(self.sheet, self.number, self.bench.device)
        try:
            with guarded(self.run, self.bench.wish) as wish:
                return sender.send(
                    job.programs[self.part.name],
                    self.bench.port,
                    job.plan.machine,
                    progress=tell,
                    start=start,
                    book=self.run,
                    wish=wish,
                )
        except Fenced:
            raise
        except BaseException as error:
            self.run.cut_off(str(error) or type(error).__name__)
            raise

    def end(self, delivery: Delivery) -> State:
        """Give the token back and say how the program stands.

        Where a machine can never answer, a person says whether it has finished. One that can, and
        did not confirm, may still be at work: opening the next program would discard what it holds.
        """
        assert self.run is not None
        state = _ENDS[delivery.status]
        self.run.end(state, delivery.fault or delivery.proved)
        operator, answers = self.bench.operator, self.bench.job.plan.machine.serial.answers
        if state is State.UNCONFIRMED and not answers and operator.has_finished(self.record):
            finished = Said(Word.FINISHED)
            return self.ledger.say(self.sheet, self.number, finished, operator.who).state
        return state
