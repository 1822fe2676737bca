"""Sheets that are left half made on a simulated plotter, and what lies on them in the end."""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from fabricate.bench import Bench, small_plan, stopping
from fabricate.verify import knife_job

from foldmill_fabricate import folder, shelf
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.plotter.errors import Stopped
from foldmill_fabricate.plotter.ledger import Ledger, SheetRecord
from foldmill_fabricate.remaking import Fate, Spoken
from foldmill_fabricate.sending import Job, open_job

ONE_TOOL, PENS, KNIFE = "generic-hpgl-600", "generic-hpgl-pens", "generic-hpgl-drag-knife"
LASER = "grbl-laser"

Path_ = tuple[tuple[float, float], ...]
Cut = Counter[tuple[Face, Path_]]


@cache
def swivelled() -> Plan:
    """A job whose blade is lifted out at the sharp corners of the outline."""
    cutter = shelf.machine(KNIFE)
    return make(knife_job.fold(), knife_job.material(swivel=20.0), cutter, blank=(260.0, 240.0))


def job_of(path: Path, plan: Plan) -> Job:
    """Write a job folder in its machine's language, and read it as it would be sent."""
    folder.write(knife_job.fold(), plan, path, [plan.machine.language])
    return open_job(path)


@dataclass
class Whole:
    """What a sheet holds on which nothing went wrong."""

    cut: Cut
    programs: list[list[Path_]]
    """Of each program its strokes, as the machine made them."""


def whole(job: Job) -> Whole:
    """Make a sheet on which nothing goes wrong."""
    bench = Bench(job.plan)
    programs: list[list[Path_]] = []
    for sent in send_job(job, bench.url, bench.hands):
        assert sent.state.value == "done"
        done = sum(len(each) for each in programs)
        programs.append(in_order(bench)[done:])
    made = Whole(cut(bench), programs)
    bench.leave()
    return made


def in_order(bench: Bench) -> list[Path_]:
    """Return the strokes of a sheet, the front's before the reverse's."""
    return [_path(one) for face in Face for one in bench.simulator.sheet.strokes[face]]


def cut(bench: Bench) -> Cut:
    """Return each stroke that lies on the sheet, and how often."""
    lying = bench.simulator.sheet.strokes
    return Counter((face, _path(one)) for face in Face for one in lying[face])


def _path(stroke: object) -> Path_:
    return tuple((float(x), float(y)) for x, y in stroke.points)  # type: ignore[attr-defined]


def left_half_made(job: Job, bench: Bench, ledger: Ledger, number: int, after: int) -> SheetRecord:
    """Stop a program after so many instructions, and let the machine come to rest."""
    name = job.plan.programs[number].name
    with suppress(Stopped):
        list(send_job(job, bench.url, bench.hands, tell=stopping(name, after), ledger=ledger))
    bench.simulator.clock.sleep(5)
    bench.simulator.advance()
    (sheet,) = ledger.open_sheets()
    return sheet


def seen(sheet: SheetRecord, bench: Bench, sound: Whole) -> list[Spoken]:
    """Say what a person sees of the strokes in doubt on the simulated sheet."""
    lying = in_order(bench)
    said: list[Spoken] = []
    for record, wanted in zip(sheet.records, sound.programs, strict=True):
        mine, lying = lying[: len(wanted)], lying[len(wanted) :]
        for stroke in record.doubtful:
            fate = Fate.MISSING if stroke >= len(mine) else Fate.HALF
            fate = Fate.CUT if fate is Fate.HALF and mine[stroke] == wanted[stroke] else fate
            said.append(Spoken(fate, frozenset({stroke}), program=record.program.name))
    return said


def plan_of(slug: str) -> Plan:
    """Return the small job for a kind of machine."""
    return small_plan(slug)
