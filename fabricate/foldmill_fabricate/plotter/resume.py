"""The rest of a program, from the beginning of a stroke or from a vertex inside it.

What a machine was told of tool, speed and force is told again; IN and DF are not, for they would
forget where a person has set the origin. Only absolute programs can be taken up again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import hypot

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter import blade
from foldmill_fabricate.plotter.errors import ProgramRefused
from foldmill_fabricate.plotter.program import PART, XY, Job, numbers, ready, rechunk

STEP = 1.0
"""A machine that rounds may report a neighbouring step."""
_FRESH = (b"IN", b"DF")
"""Begin a job anew; not said again."""
_WAYS = (b"PA", b"PU", b"PD")


@dataclass(frozen=True)
class Start:
    """Where a program is begun, or taken up again."""

    stroke: int = 0
    vertex: int = 0
    """Vertex of that stroke where the tool goes down."""
    overlap: float = 0.0
    """mm of the way before that vertex which are cut once more."""
    again: tuple[int, ...] = ()
    """Strokes that are drawn before, such as a lead-in that turns the blade."""

    @property
    def is_fresh(self) -> bool:
        """Whether nothing is left out."""
        return not (self.stroke or self.vertex)


@dataclass
class _Traced:
    """A stroke as it is drawn, and what was set before it."""

    settings: list[bytes] = field(default_factory=list)
    """Instructions, the last of each name."""
    path: list[XY] = field(default_factory=list)
    """From where the tool goes down to where it is lifted, steps; empty where it never goes down.
    """


def vertices(job: Job, stroke: int) -> list[XY]:
    """Return the places of a stroke, steps, from where the tool goes down; [] if it never does.

    Raises ProgramRefused for relative moves.
    """
    return _traced(job, stroke).path


def lead_in(job: Job, stroke: int) -> tuple[int, ...]:
    """Return the stroke that turned the blade for this one: the first after its tool was chosen."""
    first, chosen = 0, True
    for part in job.parts:
        for one, two, _ in PART.findall(part.data):
            name = (one + two).upper()
            chosen = chosen or name == b"SP"
            if chosen and name == b"PD":
                first, chosen = part.stroke, False
        if part.stroke >= stroke:
            break
    return (first,) if first < stroke else ()


def locate(job: Job, acked: int, sent: int, at: XY, *, is_down: bool | None = None) -> Start | None:
    """Return from where a tool that stands at ``at`` (steps) goes on.

    acked, sent : strokes that are cut, and that may be; is_down : whether the tool is in the sheet,
    None for not known. None where it stands at no vertex of what is in doubt, or could stand at
    several: a stroke that is repeated comes by again. A tool that is down has left the stroke's
    first vertex behind, for it is lowered by the instruction that moves it.
    """
    found = {
        Start(k + 1) if v == len(vertices(job, k)) - 1 else Start(k, v)
        for k, passed in passes(job, acked - 1, sent, at)
        for v in passed
        if v or not is_down
    }
    found = {start for start in found if start.stroke >= acked}
    return found.pop() if len(found) == 1 else None


def passes(job: Job, first: int, last: int, at: XY) -> list[tuple[int, list[int]]]:
    """Return which strokes from ``first`` to before ``last`` come by a place (steps), and where.

    Each with the numbers of its vertices there.
    """
    found = []
    for k in range(max(0, first), last):
        path = vertices(job, k)
        here = [v for v, (x, y) in enumerate(path) if max(abs(x - at[0]), abs(y - at[1])) <= STEP]
        found += [(k, here)] if here else []
    return found


def rest(job: Job, machine: Machine, limit: int, start: Start) -> Job:
    """Return what is left of a program from a place on.

    limit : longest instruction, bytes. Strokes keep their numbers; what is drawn before counts to
    the first. Raises ProgramRefused for a stroke or vertex that is not there.
    """
    last, stroke, vertex = job.parts[-1].stroke, start.stroke, start.vertex
    if not 0 <= stroke <= last:
        raise ProgramRefused(f"The program has strokes 1 to {last + 1}, not {stroke + 1}.")
    found = _traced(job, stroke)
    if not 0 <= vertex < max(1, len(found.path)):
        raise ProgramRefused(
            f"Stroke {stroke + 1} has vertices 0 to {max(0, len(found.path) - 1)}, not {vertex}."
        )
    behind, ahead = _parted(found.path, vertex, start.overlap * machine.axes.units_per_mm)
    before = [_drawn(way) for way in _led_in(job, machine, start, behind)]
    begun = rechunk(b"".join([*found.settings, *before, _drawn(ahead)]), limit)
    after = [part for part in job.parts if part.stroke > stroke]
    timed = ready(begun + b"".join(part.data for part in after), machine)
    strokes = [stroke] * (len(timed.parts) - len(after)) + [part.stroke for part in after]
    parts = [replace(part, stroke=k) for part, k in zip(timed.parts, strokes, strict=True)]
    return replace(timed, parts=tuple(parts), strokes=job.strokes)


def _traced(job: Job, stroke: int) -> _Traced:
    """Follow a program to the end of a stroke."""
    found, at = _Traced(), (0.0, 0.0)
    named: dict[bytes, bytes] = {}
    is_down = False
    for part in job.parts:
        if part.stroke > stroke:
            break
        for first, second, text in PART.findall(part.data):
            name = (first + second).upper()
            if name == b"PR":
                raise ProgramRefused("A program of relative moves cannot be taken up again.")
            if name not in _WAYS:
                named.pop(name, None)
                named[name] = name + text.strip() + b";\n"
                continue
            is_down = is_down if name == b"PA" else name == b"PD"
            way = _pairs(numbers(text))
            if part.stroke == stroke and is_down:
                found.path += [at, *way] if not found.path else way
            at = way[-1] if way else at
    found.settings = [text for name, text in named.items() if name not in _FRESH]
    return found


def _pairs(flat: Sequence[float]) -> list[XY]:
    return list(zip(flat[::2], flat[1::2], strict=True))


def _led_in(job: Job, machine: Machine, start: Start, behind: list[XY]) -> list[list[XY]]:
    """Return the ways in the waste that turn a blade as it pointed where the program goes on.

    behind : the way of the stroke that is taken up again, up to there.
    """
    ways = [_traced(job, one).path for one in start.again]
    offset = machine.tools.host_offset * machine.axes.units_per_mm
    if ways and offset:
        came = [_traced(job, k).path for k in range(start.again[0], start.stroke)]
        wanted = blade.heading([*came, behind], offset)
        turned = blade.swung(ways[-1][-1], blade.heading(ways, offset), wanted, offset)
        ways[-1] = [*ways[-1], *turned]
    return ways


def _parted(path: list[XY], vertex: int, overlap: float) -> tuple[list[XY], list[XY]]:
    """Part a way at a vertex, or ``overlap`` steps before it where there is so much behind it."""
    ahead, behind = path[vertex:], path[: vertex + 1]
    while len(behind) > 1 and overlap > 0:
        here, before = behind[-1], behind[-2]
        length = hypot(before[0] - here[0], before[1] - here[1])
        if length > overlap:
            spot = _between(here, before, overlap / length)
            return [*behind[:-1], spot], [spot, *ahead]
        ahead, overlap, behind = [before, *ahead], overlap - length, behind[:-1]
    return behind, ahead


def _between(here: XY, there: XY, share: float) -> XY:
    x = round(here[0] + share * (there[0] - here[0]))
    return float(x), float(round(here[1] + share * (there[1] - here[1])))


def _drawn(path: list[XY]) -> bytes:
    if len(path) < 2:
        return b""
    start, *onward = (f"{x:.0f},{y:.0f}" for x, y in path)
    return f"PU{start};\nPD{','.join(onward)};\nPU;\n".encode()
