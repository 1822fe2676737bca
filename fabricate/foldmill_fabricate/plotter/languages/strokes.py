"""The rest of a program by whole strokes, where a language knows nothing finer."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from foldmill_fabricate.plotter.errors import ProgramRefused
from foldmill_fabricate.plotter.program import Instruction, Job
from foldmill_fabricate.plotter.resume import Start


def rest(job: Job, start: Start, settings: Iterable[bytes]) -> Job:
    """Return what is left: lift, settings, the strokes that go again, and those from ``start`` on.

    Raises ProgramRefused for a stroke that is not there, and for a vertex inside one.
    """
    last = job.parts[-1].stroke
    if not 0 <= start.stroke <= last:
        raise ProgramRefused(f"The program has strokes 1 to {last + 1}, not {start.stroke + 1}.")
    if start.vertex or start.overlap:
        raise ProgramRefused("Programs in this language go on from the beginning of a stroke only.")
    said = [Instruction(each, 0.0, start.stroke, None) for each in (job.lift, *settings)]
    again = [replace(part, stroke=start.stroke) for part in job.parts if part.stroke in start.again]
    left = [part for part in job.parts if part.stroke >= start.stroke]
    return replace(job, parts=(*said, *again, *left))


def lead_in(stroke: int) -> tuple[int, ...]:
    """Return the first stroke: a program of these languages has one tool."""
    return (0,) if stroke else ()
