"""What a machine confirms while it works: questions that it answers in order, between strokes.

``OA;`` is answered when all before it is executed. Standing after a stroke, with the tool about to
be lifted, it costs no motion; its answer proves the strokes before it, and that the tool is where
the program says.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import replace

from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.program import XY, Instruction, Job
from foldmill_fabricate.plotter.resume import STEP
from foldmill_fabricate.plotter.session import Session

QUESTION = b"OA;"
EVERY = 0.5
"""s of motion between two questions, at least."""
LONG = 1.5
"""s of motion that go unconfirmed before a stroke that takes them beyond that."""


def watched(job: Job) -> Job:
    """Put a question between strokes, about every half second of motion."""
    return replace(job, parts=tuple(_watched(job.parts)))


def _watched(parts: tuple[Instruction, ...]) -> Iterator[Instruction]:
    lengths: dict[int, float] = {}
    for part in parts:
        lengths[part.stroke] = lengths.get(part.stroke, 0.0) + part.seconds
    since = 0.0
    for part, after in zip(parts, [*parts[1:], None], strict=True):
        since += part.seconds
        yield part
        if after is None or after.stroke == part.stroke or part.at is None:
            continue
        if since >= EVERY or since + lengths[after.stroke] > LONG:
            yield Instruction(QUESTION, 0.0, part.stroke, part.at, asks=True)
            since = 0.0


class Witness:
    """Counts the answers of one delivery."""

    def __init__(self, session: Session, job: Job) -> None:
        self._session, self._parts, self._strokes = session, job.parts, job.strokes
        self._open: deque[int] = deque()
        self.executed = 0
        """Instructions that are known to be executed."""

    @property
    def acked(self) -> int:
        """Strokes that are known to be executed: all before this one."""
        if self.executed < len(self._parts):
            return min(self._parts[self.executed].stroke, self._strokes)
        return self._strokes

    def written(self, number: int) -> None:
        """Learn that an instruction was written, and listen; raises PlotterError.

        That is where the machine says that it stands elsewhere than the program does.
        """
        if self._parts[number].asks:
            self._open.append(number)
        while self._open and (text := self._session.place_at_hand()) is not None:
            self._hear(text)

    def finish(self, deadline: float) -> bool:
        """Wait for the answers that are due; False where one does not come by then."""
        while self._open:
            text = self._session.place(deadline)
            if text is None:
                return False
            self._hear(text)
        return True

    def _hear(self, text: str) -> None:
        number = self._open.popleft()
        at, wanted = position(text), self._parts[number].at
        if at is None:
            raise PlotterError(
                f"The plotter answered {text!r} where it should have told its position."
            )
        if wanted is not None and is_off(at, wanted):
            stroke = self._parts[number].stroke
            raise PlotterError(
                f"After stroke {stroke + 1} the tool stands at {at[0]:g}, {at[1]:g} steps, and "
                f"the program has it at {wanted[0]:g}, {wanted[1]:g}: something was lost."
            )
        self.executed = number + 1


def position(answer: str) -> XY | None:
    """Read x and y from an answer; None for what is none."""
    try:
        x, y = (float(each) for each in answer.split(",")[:2])
    except ValueError:
        return None
    return x, y


def is_off(at: XY, wanted: XY) -> bool:
    """Tell whether two places are more than a step apart."""
    return max(abs(at[0] - wanted[0]), abs(at[1] - wanted[1])) > STEP
