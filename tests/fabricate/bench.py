"""A small job on a simulated plotter, and people who say what a test wants said."""

from __future__ import annotations

from functools import cache
from itertools import count
from pathlib import Path

from fabricate.verify import knife_job

from foldmill_fabricate import folder, shelf
from foldmill_fabricate.delivering import Tell
from foldmill_fabricate.gates import Answer, Request
from foldmill_fabricate.operators import SimulatedOperator, Verdict
from foldmill_fabricate.passes import Gate, Plan, ProgramFile
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.ledger import Record, Said
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.sender import Progress
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.sending import Job, open_job

_numbers = count()


@cache
def small_plan(slug: str = "generic-hpgl-600") -> Plan:
    """A square with four creases, both faces."""
    return make(knife_job.fold(), knife_job.material(), shelf.machine(slug), blank=(260.0, 240.0))


def small_job(path: Path, plan: Plan | None = None) -> Job:
    """Write it, and read it as it would be sent."""
    folder.write(knife_job.fold(), plan or small_plan(), path, ["hpgl"])
    return open_job(path)


class Hands(SimulatedOperator):
    """Does and says what it is told to, and remembers what it was asked."""

    def __init__(self, url: str) -> None:
        super().__init__(url)
        self.answers: dict[Gate, Answer | None] = {}
        """In place of what it would say at a gate."""
        self.words: list[Said | None] = []
        self.verdicts: list[Verdict] = []
        self.gates: list[Gate] = []
        self.offered: list[str] = []
        self.asked: list[tuple[Record, Start | None, str]] = []

    def ready(self, request: Request) -> Answer | None:
        self.gates.append(request.gate)
        done = super().ready(request)
        return self.answers.get(request.gate, done)

    def wants_test_cut(self, request: Request) -> bool:
        self.offered.append(request.setup.name)
        return bool(self.verdicts)

    def judge(self, request: Request) -> Verdict:
        return self.verdicts.pop(0) if self.verdicts else super().judge(request)

    def decide(self, record: Record, found: Start | None, told: str) -> Said | None:
        self.asked.append((record, found, told))
        return self.words.pop(0) if self.words else super().decide(record, found, told)


class Bench:
    """A simulated plotter with somebody beside it."""

    def __init__(self, plan: Plan) -> None:
        self.simulator = Simulator(plan.machine)
        self.url = devices.plug(f"small-{next(_numbers)}", self.simulator)
        self.hands = Hands(self.url)

    def leave(self) -> None:
        """Put it away."""
        devices.unplug(self.url)


def stopping(name: str, after: int) -> Tell:
    """Press Ctrl-C after so many instructions of a program."""

    def tell(part: ProgramFile, progress: Progress) -> None:
        if part.name == name and progress.instructions == after:
            raise KeyboardInterrupt

    return tell
