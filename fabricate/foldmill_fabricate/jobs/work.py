"""Work on one job until it ends: sheet after sheet, asking where only a person can say.

Nothing that goes wrong ends a job: it asks, and goes on on a person's word. What is certain of a
sheet stands in the ledger, so this may be killed anywhere and begun again.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, field
from threading import Event, Thread

from foldmill.errors import FoldmillError
from foldmill_fabricate.choosing import NEW, choose_sheet
from foldmill_fabricate.delivering import Sent, send_job
from foldmill_fabricate.gates import Request
from foldmill_fabricate.jobs.errors import Cancelled, GivenUp, JobRefused, Leave
from foldmill_fabricate.jobs.hands import LOOK, Hands
from foldmill_fabricate.jobs.places import Places
from foldmill_fabricate.jobs.plans import Plans
from foldmill_fabricate.jobs.plotters import Plotter
from foldmill_fabricate.jobs.proving import Elsewhere
from foldmill_fabricate.jobs.states import JobState
from foldmill_fabricate.jobs.store import CANCEL, PAUSE, JobStore
from foldmill_fabricate.jobs.values import JobRecord, Kind
from foldmill_fabricate.passes import Face, Gate, ProgramFile
from foldmill_fabricate.plotter.errors import Fenced, LedgerFailed, PlotterError, Spoiled
from foldmill_fabricate.plotter.holding import Holder
from foldmill_fabricate.plotter.ledger import SheetRecord
from foldmill_fabricate.plotter.sender import Progress
from foldmill_fabricate.plotter.wish import Wish
from foldmill_fabricate.sending import Job, open_job

_LOG = logging.getLogger(__name__)
_FACES = tuple(Face)
_END = "Wait until it is done, or end it: foldmill job cancel {}."


class Tell:
    """Hears how far programs are; a service counts and shows it."""

    def sent(self, job: JobRecord, sheet: str, part: ProgramFile, progress: Progress) -> None:
        """Hear of an instruction that has left."""

    def ended(self, job: JobRecord, sent: Sent) -> None:
        """Hear of a program that has ended, and how."""

    def broke_off(self, job: JobRecord, why: PlotterError) -> None:
        """Hear of a program that did not get to its end."""


@dataclass(frozen=True)
class Shop:
    """What all work of a service has in common."""

    store: JobStore
    plans: Plans
    places: Places
    leaving: Event
    """Set when the process is to end: machines are stopped, and what was under way is in doubt."""
    tell: Tell = field(default_factory=Tell)
    proven: set[str] = field(default_factory=set)
    """Digests of the folders that were proved for this very process."""


def work(shop: Shop, job: JobRecord, token: int, plotter: Plotter) -> None:
    """Work on a job, as the holder of its token, until it ends.

    Raises Leave where the process is to end, Fenced where somebody else has the job, LedgerFailed
    where nothing can be written down any more.
    """
    try:
        with watching(shop, job.id, token) as wish:
            _Work(shop, job, token, plotter, wish).make()
    except Cancelled:
        shop.store.move(job.id, token, JobState.CANCELLED, "A person ended it.")
    except GivenUp as error:
        shop.store.move(job.id, token, JobState.FAILED, str(error))


class watching:  # noqa: N801
    """Hear, beside the work, what a person wants of a job, and whether the process ends."""

    def __init__(self, shop: Shop, job: str, token: int) -> None:
        self._shop, self._job, self._token = shop, job, token
        self._wish, self._over = Wish(), Event()
        self._thread = Thread(target=self._watch, name=f"wishes of {job}", daemon=True)

    def __enter__(self) -> Wish:
        self._is_heard_out()  # what was wanted before counts from the first byte on
        self._thread.start()
        return self._wish

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._over.wait(LOOK):
            if self._is_heard_out():
                return

    def _is_heard_out(self) -> bool:
        """Hear what is wanted now; True where all is to stop, and nothing more is to be heard."""
        if self._shop.leaving.is_set():
            self._wish.stop()
            return True
        try:
            self._hear(self._shop.store.wish(self._job, self._token))
        except Fenced:
            self._wish.stop()  # who has the job now must not find its machine at work
            return True
        except (JobRefused, LedgerFailed):
            pass  # the work itself meets it, and says so
        except Exception:  # a database that is away for a moment must not end the watch
            _LOG.exception("wishes of job %s", self._job)
        return False

    def _hear(self, wanted: str) -> None:
        if wanted == CANCEL:
            self._wish.stop()
        elif wanted == PAUSE:
            self._wish.pause()
            self._show(JobState.RUNNING, JobState.PAUSED)
        elif not wanted and self._wish.paused:
            self._wish.go_on()
            self._show(JobState.PAUSED, JobState.RUNNING)

    def _show(self, was: JobState, to: JobState) -> None:
        if self._shop.store.job(self._job).state is was:
            self._shop.store.move(self._job, self._token, to)


class _Work:
    """One job at its plotter."""

    def __init__(
        self, shop: Shop, job: JobRecord, token: int, plotter: Plotter, wish: Wish
    ) -> None:
        self.shop, self.job, self.token, self.plotter, self.wish = shop, job, token, plotter, wish
        self.store, self.ledger = shop.store, shop.store.ledger
        self.hands = Hands(shop.store, job.id, token, shop.leaving, plotter.port)
        self.opened: Job | None = None

    def make(self) -> None:
        """Make all its sheets."""
        made = 0
        for sheet in self.job.sheets:
            made += self._make_sheet(sheet)
        while made < self.job.copies:
            made += self._make_sheet("")
        self.store.move(self.job.id, self.token, JobState.RUNNING)
        self.store.move(self.job.id, self.token, JobState.DONE)

    def _make_sheet(self, sheet: str) -> bool:
        """Make a sheet; False where it was given up, and another is made in its place."""
        told = ""
        while True:
            self.hands.heed()
            if sheet and not (record := self.ledger.sheet(sheet)).is_open:
                return self._is_made(record, told)
            try:
                opened = self._open()
                sheet = sheet or self._lay(opened)
                self.hands.sheet = sheet
                self._send(opened, sheet)
            except Spoiled as error:
                told = str(error)
            except (Cancelled, GivenUp, Leave, Fenced, LedgerFailed):
                raise
            except FoldmillError as error:
                if not self._is_given_up(sheet):
                    self._trouble(str(error), sheet)
            except Exception as error:  # a job asks rather than ends, whatever it is
                _LOG.exception("job %s", self.job.id)
                self._trouble(f"Something unforeseen went wrong: {error!r}.", sheet)

    def _open(self) -> Job:
        """Prove the plan, once: what was proved is held here, and is what is sent."""
        if self.opened is None:
            folder = self.shop.plans.folder(self.job.plan)
            there = Elsewhere(self.hands.heed, self.shop.proven)
            prover, fitter, trier = there.prove, there.fit, there.trial
            self.opened = open_job(folder, prover=prover, fitter=fitter, trier=trier)
        return self.opened

    def _lay(self, opened: Job) -> str:
        """Begin a sheet, in the ledger first: where this ends in between, it is one never used."""
        sheet = choose_sheet(self.ledger, opened, _FACES, NEW).id
        self.store.begin_sheet(self.job.id, self.token, sheet)
        return sheet

    def _send(self, opened: Job, sheet: str) -> None:
        """Send what is left of a sheet; it ends early where a person has to say how it goes on."""
        tell = self.shop.tell
        transcript = self.shop.places.new_transcript(self.job.id, sheet)
        parts = send_job(
            opened,
            self.plotter.port,
            self.hands,
            _FACES,
            lambda part, progress: tell.sent(self.job, sheet, part, progress),
            self.ledger,
            sheet,
            transcript=transcript,
            wish=self.wish,
            holder=Holder(f"job {self.job.id}", _END.format(self.job.id)),
        )
        try:
            for sent in parts:
                tell.ended(self.job, sent)
        except PlotterError as error:
            tell.broke_off(self.job, error)
            raise

    def _trouble(self, why: str, sheet: str) -> None:
        """Ask a person to put right what is in the way; no: the job ends."""
        self.hands.heed()  # a stop that was wanted is no trouble
        text = f"{why}\nOnce that is put right, it is tried again; or end the job."
        try:
            again = self._asked(Kind.TROUBLE, text, sheet)
        except Spoiled:
            return  # what was in the way no longer is
        if not again:
            raise Cancelled("Ended by a person.")

    def _is_made(self, record: SheetRecord, told: str = "") -> bool:
        """Tell whether a sheet that is closed was made; ask for another where it was given up.

        told : how the machine was stopped, where it was at work then.
        """
        self.hands.sheet = ""
        if not record.is_given_up:
            self._have_removed(record.id)
            return True
        text = f"{told or f'Sheet {record.id} was given up.'} Is another one made in its place?"
        if record.id in self.job.sheets[:-1] or self._asked(Kind.ANOTHER, text, record.id):
            return False
        raise GivenUp(f"Sheet {record.id} was given up.")

    def _is_given_up(self, sheet: str) -> bool:
        return bool(sheet) and self.ledger.sheet(sheet).is_given_up

    def _have_removed(self, sheet: str) -> None:
        """Have a sheet taken off that was made just before a crash, and nobody has spoken of."""
        if all(one.gate != Gate.REMOVE.value for one in self.ledger.answers(sheet)):
            plan = self._open().plan
            last = plan.passes[-1]
            request = Request(Gate.REMOVE, last.face, last.setups[-1], plan, sheet)
            answer = self.hands.ready(request)
            self.ledger.answer(sheet, None, Gate.REMOVE, answer.told, answer.who)

    def _asked(self, kind: Kind, text: str, sheet: str) -> bool:
        return self.hands.ask(kind, text, sheet=sheet)[0].ok
