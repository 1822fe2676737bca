"""What a machine confirms while it works: questions that it answers in order, between strokes.

``OA;OE;`` is answered when all before it is executed. Standing after a stroke, with the tool about
to be lifted, it costs no motion; its answers prove the strokes before it, that the tool is where
the program says, and that nothing before it was an error.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import replace
from math import inf

from foldmill_fabricate.plotter.errors import LineDisturbed, NoAnswer
from foldmill_fabricate.plotter.handshakes.hp import HpSession
from foldmill_fabricate.plotter.program import XY, Instruction, Job
from foldmill_fabricate.plotter.resume import STEP

QUESTION = b"OA;OE;"
EVERY = 0.5
"""s of motion between two questions, at least."""
LONG = 1.5
"""s of motion that go unconfirmed before a stroke that takes them beyond that."""

_OE = {
    1: "an instruction it does not know",
    2: "a wrong number of parameters",
    3: "a parameter out of range",
    5: "an unknown character set",
    6: "a position beyond its limits",
    8: "its pinch wheels up",
}


def watched(job: Job, *questions: bytes) -> Job:
    """Put questions (``OA;OE;``) between strokes, about every half second of motion."""
    return replace(job, parts=tuple(_watched(job.parts, questions or (QUESTION,))))


def _watched(parts: tuple[Instruction, ...], questions: tuple[bytes, ...]) -> Iterator[Instruction]:
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
            for question in questions:
                yield Instruction(question, 0.0, part.stroke, part.at, asks=True, down=part.down)
            since = 0.0


class Witness:
    """Counts the answers of one delivery."""

    def __init__(self, session: HpSession, job: Job) -> None:
        self._session, self._parts, self._strokes = session, job.parts, job.strokes
        self._open: deque[tuple[int, float]] = deque()
        self.executed = 0
        """Units that are known to be executed."""
        self.seen_open = -inf, 0
        """When a question was last seen to be unanswered, s, and its number."""

    @property
    def acked(self) -> int:
        """Strokes that are known to be executed: all before this one."""
        return self.strokes_before(self.executed)

    def strokes_before(self, number: int) -> int:
        """Return the strokes that are whole before a unit."""
        if number < len(self._parts):
            return min(self._parts[number].stroke, self._strokes)
        return self._strokes

    @property
    def waits(self) -> bool:
        """Whether an answer is due."""
        return bool(self._open)

    def written(self, number: int, deadline: float) -> None:
        """Learn that a unit was written, and when an answer to it is overdue."""
        if self._parts[number].asks:
            self._open.append((number, deadline))

    def hear(self) -> None:
        """Hear what has come; raises LineDisturbed.

        That is where the machine says that it stands elsewhere than the program does, or reports an
        error.
        """
        while self._open and (proof := self._session.proof_at_hand()) is not None:
            self._prove(*proof)
        if self._open:
            self.seen_open = self._session.clock.now(), self._open[0][0]

    def overdue(self) -> None:
        """Raise NoAnswer where an answer should have come by now."""
        if self._open and self._session.clock.now() > self._open[0][1]:
            stroke = self._parts[self._open[0][0]].stroke
            raise NoAnswer(
                f"The plotter has not confirmed stroke {stroke + 1} in the time that takes: it "
                "stands still, is far slower than its profile says, or its answers are lost."
            )

    def finish(self, deadline: float) -> bool:
        """Wait for the answers that are due; False where one does not come by then."""
        while self._open:
            proof = self._session.proof(deadline)
            if proof is None:
                return False
            self._prove(*proof)
        return True

    def _prove(self, place: str, error: str) -> None:
        number, _ = self._open.popleft()
        at, wanted, stroke = position(place), self._parts[number].at, self._parts[number].stroke
        if at is None:
            raise LineDisturbed(
                f"The plotter answered {place!r} where it should have told its position."
            )
        if wanted is not None and is_off(at, wanted):
            raise LineDisturbed(
                f"After stroke {stroke + 1} the tool stands at {at[0]:g}, {at[1]:g} steps, and "
                f"the program has it at {wanted[0]:g}, {wanted[1]:g}: something was lost."
            )
        if error != "0":
            raise LineDisturbed(f"By stroke {stroke + 1}, {reported(error)}")
        self.executed = number + 1


def reported(error: str) -> str:
    """Say what an answer to OE means."""
    meaning = _OE.get(int(error), "an error") if error.isdigit() else "something else"
    return f"the machine reports error {error}: {meaning}."


def position(answer: str) -> XY | None:
    """Read x and y from an answer; None for what is none."""
    try:
        x, y = (float(each) for each in answer.split(",")[:2])
    except ValueError:
        return None
    return x, y


def is_off(at: XY, wanted: XY, step: float = STEP) -> bool:
    """Tell whether two places are more than a step apart."""
    return max(abs(at[0] - wanted[0]), abs(at[1] - wanted[1])) > step
