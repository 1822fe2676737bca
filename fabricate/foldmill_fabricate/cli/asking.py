"""How a job stands, in words: its line, what it asks, and the commands that answer that."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from foldmill_fabricate.cli.layout import hanging

if TYPE_CHECKING:
    from foldmill_fabricate.jobs import JobRecord, Question

_BELOW = " " * 6
"""Where what belongs to a job begins."""
_WORDS = {
    "load": ("[--thickness MM] [--temperature °C]",),
    "tool": ("[--exposure MM]",),
    "flip": ("--sheet ID-ON-THE-SHEET [--temperature °C]",),
    "re-register": ("--sheet ID-ON-THE-SHEET [--touched]",),
    "remove": ("",),
    "try": ("--no  # none", "  # cut one"),
    "judge": ("--verdict good  # or again, or stop",),
    "decide": ("--go-on STROKE", "--finished  # all of it is cut", "--spoiled  # give it up"),
    "finished": ("  # it is done", "--no"),
    "trouble": ("  # try again", "--no  # end the job"),
    "another": ("  # make another", "--no  # end the job"),
}
"""What follows the id of a question in the commands that answer it, by its kind."""


def told(job: JobRecord, asked: Sequence[Question] = ()) -> str:
    """Return how a job stands, and what it asks; what a question says is said once."""
    mine = [one for one in asked if one.job == job.id]
    said = any(job.note and one.text.strip().startswith(job.note.strip()) for one in mine)
    count = f"{job.copies} × " if job.copies > 1 else ""
    note = f": {job.note}" if job.note and not said else ""
    wish = f" (to be {'paused' if job.wish == 'pause' else 'cancelled'})" if job.wish else ""
    rank = f", priority {job.priority}" if job.priority else ""
    what = f"{count}{job.title}, {job.material}, on {job.plotter}{rank}"
    head = hanging(f"{job.id}  {what}: {job.state.value}{wish}{note}", _BELOW)
    return "\n".join([head, *map(question, mine)])


def question(one: Question) -> str:
    """Return what is asked, and how it is answered."""
    where = f" {one.setup}" if one.setup else ""
    asks = f"{_BELOW}asks {one.id} ({one.kind.value}{where}): {one.text.strip()}"
    lines = [hanging(line, _BELOW) for line in asks.replace("\n", f"\n{_BELOW}").split("\n")]
    return "\n".join([*lines, *(f"{_BELOW}  {command}" for command in commands(one))])


def commands(one: Question) -> list[str]:
    """Return the commands that answer a question; a place that the machine proves needs no word.

    The id of a sheet is left to be read off the sheet: that is what it is for.
    """
    proved: tuple[str, ...] = ("  # as the machine stands",) if "proved" in one.data else ()
    endings = (*proved, *_WORDS.get(one.kind.value, ("",)))
    return [f"foldmill job answer {one.id} {ending}".rstrip() for ending in endings]
