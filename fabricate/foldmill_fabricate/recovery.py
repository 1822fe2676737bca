"""How a program that ended before its end goes on: where the machine stands, and what may be said.

The plotter layer knows strokes and places; what is a score and what a through-cut is known here.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import Any

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.jogging import carrier
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import ProgramFile, SetUp
from foldmill_fabricate.plotter import resume
from foldmill_fabricate.plotter.errors import LedgerRefused
from foldmill_fabricate.plotter.handshakes.hp import DROPS
from foldmill_fabricate.plotter.languages import made_ready, spoken
from foldmill_fabricate.plotter.ledger import Record, Said, Word
from foldmill_fabricate.plotter.program import PART
from foldmill_fabricate.plotter.program import Job as Program
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.standing import Stand, stand
from foldmill_fabricate.sending import Job

_FEW = 3
"""Strokes that are told one by one."""


@dataclass(frozen=True)
class Place:
    """Where a machine stands, as far as it proves that."""

    start: Start | None
    """From where it goes on; None where that is not proved."""
    told: str = ""
    """What is known, a sentence; empty for nothing."""


def standing(job: Job, part: ProgramFile, record: Record, port: Any) -> Place:
    """Ask the machine where it stands, and find that in what is in doubt of a program."""
    last = record.runs[-1]
    if last.sent == last.acked:
        inside = last.vertex if last.acked == last.first else 0  # what was cut of it before
        return Place(Start(last.acked, inside))  # nothing is in doubt
    machine = job.plan.machine
    program = program_of(job, part)
    where = _where(program, record, machine)
    found = stand(port, machine) if machine.language == "hpgl" else None
    if found is None:
        return Place(None, f"{where} {half(machine)}".strip())
    start = resume.locate(program, last.acked, last.sent, found.at, is_down=found.is_down)
    if start is not None:
        return Place(start, where)
    return Place(None, f"{where} {_told(program, last.acked, last.sent, found, machine)}".strip())


def half(machine: Machine) -> str:
    """Say what to do where half an instruction may lie in a machine that cannot drop it.

    The next bytes would end it: a number cut short is a line to somewhere else.
    """
    if machine.language != "hpgl" or machine.serial.handshake in DROPS:
        return ""
    return (
        "Half an instruction may lie in the machine, which cannot be told to drop it: lift the "
        "tool and switch the machine off and on before you answer."
    )


def _where(program: Program, record: Record, machine: Machine) -> str:
    """Say where doubtful strokes are to be looked for: all of them, or the first and the last."""
    if machine.language != "hpgl":
        return ""
    strokes = [k for k in record.doubtful if resume.vertices(program, k)]
    shown = strokes if len(strokes) <= _FEW else [strokes[0], strokes[-1]]
    return " ".join(_line(program, k, machine) for k in shown)


def _line(program: Program, stroke: int, machine: Machine) -> str:
    path = [carrier(spot, machine) for spot in resume.vertices(program, stroke)]
    far = max(path, key=lambda spot: hypot(spot[0] - path[0][0], spot[1] - path[0][1]))
    (x, y), (u, v) = path[0], far
    return f"Stroke {stroke + 1} lies from ({x:.1f}, {y:.1f}) to ({u:.1f}, {v:.1f}) mm on the mat."


def program_of(job: Job, part: ProgramFile) -> Program:
    """Return a program as the sender sees it."""
    machine = job.plan.machine
    return made_ready(job.programs[part.name], machine)


def _told(program: Program, acked: int, sent: int, found: Stand, machine: Machine) -> str:
    """Say in which strokes a machine may stand that does not prove from where it goes on."""
    x, y = carrier(found.at, machine)
    tool = "" if found.is_down is None else ", its tool down" if found.is_down else ", its tool up"
    where = f"The machine stands at ({x:.1f}, {y:.1f}) mm{tool}"
    passed = resume.passes(program, acked, sent, found.at)
    if not passed:
        return f"{where}: at no vertex of a stroke that is in doubt."
    strokes = ", and ".join(_passing(stroke, vertices) for stroke, vertices in passed)
    return f"{where}: {strokes}. Which time it was it cannot say."


def _passing(stroke: int, vertices: list[int]) -> str:
    at = ", ".join(map(str, vertices))
    often = "once" if len(vertices) == 1 else f"{len(vertices)} times"
    return f"stroke {stroke + 1} comes by there {often} (vertex {at})"


def refuse(job: Job, part: ProgramFile, said: Said) -> None:
    """Raise LedgerRefused where a word would cut again what must not be.

    Only a through-cut may be cut again for some mm: a score gets deeper by it.
    """
    if said.word is not Word.GO_ON or not said.overlap:
        return
    setup = setup_at(job, part, said.stroke)
    name = f"Stroke {said.stroke + 1} of {part.name}"
    if setup.process != "cut" or not job.plan.material.cut.goes_through:
        raise LedgerRefused(
            f"{name} is a {'score' if setup.process == 'score' else 'groove'}: {said.overlap:g} mm "
            "of it cut again would be deeper than the rest. An overlap is for through-cuts; leave "
            "it out."
        )
    if not said.vertex:
        raise LedgerRefused(
            f"{name} is to be cut from its start, and there is nothing before it to overlap. Name "
            "the vertex from which it goes on, such as 12.3, or leave the overlap out."
        )


def setup_at(job: Job, part: ProgramFile, stroke: int) -> SetUp:
    """Return the set-up that a stroke of a program belongs to: SP begins each."""
    every = {one.number: one for work in job.plan.passes for one in work.setups}
    setups = [every[number] for number in part.setups]
    if len(setups) == 1:
        return setups[0]
    chosen = -1
    for piece in program_of(job, part).parts:
        names = [(one + two).upper() for one, two, _ in PART.findall(piece.data)]
        chosen += names.count(b"SP")
        if piece.stroke >= stroke and b"PD" in names:
            break
    return setups[max(0, min(chosen, len(setups) - 1))]


def start_of(job: Job, part: ProgramFile, record: Record) -> Start:
    """Return where a program is begun, or taken up again.

    A blade of which nobody knows how it points is turned in the waste first. Raises CannotSend
    where the program was fitted since to marks, and is not made of the same strokes any more.
    """
    program = program_of(job, part)
    if program.strokes != record.program.strokes:
        raise CannotSend(
            f"{part.name} has {program.strokes} strokes as it is fitted now, and had "
            f"{record.program.strokes} when the sheet was begun. Lay the sheet as it lay."
        )
    if not job.plan.machine.tools.host_offset:
        return Start(record.first, record.vertex, record.overlap)
    again = spoken(job.plan.machine).lead_in(program, record.first)
    inside = record.vertex if again else 0  # a lead-in itself is made from its start
    return Start(record.first, inside, record.overlap, again)
