"""Send a job folder to a plotter: prove it again, ask the operator, stream program by program.

Nothing is sent that was not verified in this very call, so an edited file never reaches a machine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Protocol

from foldmill.finding import Severity
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.marks import MarkFit, fit_marks
from foldmill_fabricate.passes import Face, Gate, Plan, ProgramFile, SetUp
from foldmill_fabricate.plotter import link, sender
from foldmill_fabricate.plotter.sender import Delivery, Progress, Status
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.verify import Verification, read_folder, verify, verify_files


class Operator(Protocol):
    """Whoever stands at the machine."""

    def ready(self, gate: Gate, face: Face, setup: SetUp, plan: Plan) -> bool:
        """Do what the gate asks for, ``face`` up; False ends the job before the set-up starts."""


@dataclass(frozen=True)
class Job:
    """A verified job folder, its reverse fitted where marks were measured."""

    plan: Plan
    programs: Mapping[str, bytes]
    proof: Verification
    fit: MarkFit | None


@dataclass(frozen=True)
class Sent:
    """One program, and how its delivery ended."""

    program: ProgramFile
    delivery: Delivery


class SimulatedOperator:
    """Hands for a simulated plotter in this process: lays and turns its sheet, agrees to all."""

    def __init__(self, url: str) -> None:
        self._simulator = devices.behind(url)

    def ready(self, gate: Gate, face: Face, setup: SetUp, plan: Plan) -> bool:  # noqa: ARG002
        """Do it at once."""
        if gate is Gate.LOAD:
            self._simulator.new_sheet()
        if gate in {Gate.LOAD, Gate.FLIP} and self._simulator.sheet.up is not face:
            self._simulator.flip()
        return True


def open_job(path: Path, marks: Sequence[tuple[float, float]] = ()) -> Job:
    """Read a job folder and prove it; raises CannotSend where it must not be sent.

    marks : where registration holes are seen after the flip, carrier coordinates in mm; the reverse
    programs are written anew to fit, and proved again.
    """
    files = read_folder(path)
    plan = files.plan
    proof = verify_files(files)
    _refuse(proof, path)
    if not plan.programs:
        raise CannotSend(f"{path} holds drawings only; plan it again with --to hpgl.")
    unproved = [part.name for part in plan.programs if part.name not in files.programs]
    if unproved:
        raise CannotSend(f"{path} is not sent, for {unproved[0]} was not verified.")
    programs = {part.name: files.programs[part.name] for part in plan.programs}
    if not marks:
        return Job(plan, programs, proof, None)
    fit = fit_marks(plan, marks)
    programs |= {
        part.name: hpgl.program(plan, part.setups, fit.fit)
        for part in plan.programs
        if part.face is Face.REVERSE
    }
    proof = verify(plan, files.pattern, programs, fit.fit)
    _refuse(proof, path)
    return Job(plan, programs, proof, fit)


def _refuse(proof: Verification, path: Path) -> None:
    errors = [finding for finding in proof.findings if finding.severity is Severity.ERROR]
    if errors:
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        raise CannotSend(f"{path} is not sent, for it does not verify: {errors[0]}{more}")


def send_job(
    job: Job,
    url: str,
    operator: Operator,
    faces: Sequence[Face] = (Face.FRONT, Face.REVERSE),
    tell: Callable[[ProgramFile, Progress], None] = lambda _part, _progress: None,
) -> Iterator[Sent]:
    """Send the programs of these faces in order of work, yielding after each.

    url : any address pyserial opens, or ``sim://NAME``. tell : hears of every instruction. Raises
    CannotSend where the operator says no, PlotterError where the line fails. It ends early after
    a program that ``goes_on`` says no to.
    """
    setups = {setup.number: setup for work in job.plan.passes for setup in work.setups}
    with link.open_port(url, job.plan.machine) as port:  # before anybody loads a sheet
        for part in job.plan.programs:
            if part.face not in faces:
                continue
            first = setups[part.setups[0]]
            if not all(operator.ready(g, part.face, first, job.plan) for g in first.gates):
                raise CannotSend(f"Stopped before {part.name}, as the operator said.")
            told = partial(tell, part)
            delivery = sender.send(job.programs[part.name], port, job.plan.machine, progress=told)
            yield Sent(part, delivery)
            if not goes_on(delivery, job.plan.machine):
                return


def goes_on(delivery: Delivery, machine: Machine) -> bool:
    """Tell whether the next program may follow.

    Not after a fault, and not where a machine that can answer has not confirmed: it may still be
    at work, and opening the next program would discard what it holds. A machine that never answers
    goes on by the operator's word at the next gate.
    """
    if delivery.status is Status.UNCONFIRMED:
        return not machine.serial.answers
    return delivery.status is Status.EXECUTED
