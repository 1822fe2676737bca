"""What the simulated tool leaves on a sheet, in machine steps, per face."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.machines import Axes
from foldmill_fabricate.passes import Face

Step = tuple[int, int]


@dataclass(frozen=True)
class Imperfection:
    """How far a machine's mechanics are off what it is told, and how a flipped sheet lies on it."""

    scale_x: float = 1.0
    """Lengths along the carrier's x come out multiplied with this; so do the next along y."""
    scale_y: float = 1.0
    skew: float = 0.0
    """deg by which a line along y leans to the right."""
    flip_dx: float = 0.0
    """mm by which a flipped sheet lies too far to the right, as the machine sees it."""
    flip_dy: float = 0.0
    """mm by which it lies too far up."""

    def __call__(self, carrier: NDArray[np.float64], face: Face) -> NDArray[np.float64]:
        """Return where told points (n, 2), mm, come to be on a sheet that lies where it ought to.

        x' = scale_x·(x + y·tan skew), y' = scale_y·y, from the carrier's lower left corner; and a
        sheet that lies too far to the right gets its lines too far to the left.
        """
        x, y = carrier.T
        leant = self.scale_x * (x + y * np.tan(np.radians(self.skew)))
        off = (self.flip_dx, self.flip_dy) if face is Face.REVERSE else (0.0, 0.0)
        return np.column_stack([leant - off[0], self.scale_y * y - off[1]])


PERFECT = Imperfection()


@dataclass(frozen=True)
class Drawn:
    """One stroke as the machine made it."""

    tool: int
    """Number after SP."""
    speed: float
    """mm/s"""
    force: float | None
    """gf; None where the program sets none"""
    points: tuple[Step, ...]
    """Steps, machine axes; a single point where the tool went down and up in one place."""
    setting: str = ""
    """What else it was made with, in words, such as a laser's power."""
    face: Face = field(default=Face.FRONT, compare=False)
    """Which face was up."""
    imperfection: Imperfection = PERFECT
    """Of the machine that made it."""

    def millimetres(self, axes: Axes) -> NDArray[np.float64]:
        """Return carrier coordinates (n, 2), mm, as the machine sees the face: reverse mirrored.

        Where the line is, on a machine that is off; not where it was told to go.
        """
        xy = np.array(self.points, float) / axes.units_per_mm
        told = xy[:, ::-1] if axes.swap else xy
        if axes.top is not None:
            told = told * (1, -1) + (0, axes.top)
        return told if self.imperfection == PERFECT else self.imperfection(told, self.face)


@dataclass
class DrawnSheet:
    """A sheet on the machine: the face that is up, and the strokes on both."""

    up: Face = Face.FRONT
    imperfection: Imperfection = PERFECT
    strokes: dict[Face, list[Drawn]] = field(default_factory=lambda: {face: [] for face in Face})
    """Those that have ended."""
    _begun: tuple[int, float, float | None, str] | None = None
    _points: list[Step] = field(default_factory=list)

    @property
    def under_way(self) -> bool:
        """Whether a tool is in the sheet."""
        return self._begun is not None

    def seen(self, face: Face) -> list[Drawn]:
        """Return what can be seen on a face: its strokes, and the one that is under way."""
        if self._begun is None or face is not self.up:
            return list(self.strokes[face])
        return [*self.strokes[face], self._stroke()]

    def lower(
        self, at: Step, tool: int, speed: float, force: float | None, setting: str = ""
    ) -> None:
        """Begin a stroke; one that is under way with other settings ends first.

        Where the tool has only been lowered yet, by its own axis, that one takes the settings.
        """
        if self._begun == (tool, speed, force, setting):
            return
        if len(self._points) != 1 or self._begun is None or self._begun[0] != tool:
            self.lift()
        self._begun, self._points = (tool, speed, force, setting), [at]

    def move(self, to: Step) -> None:
        """Go on with the stroke that is under way, if any."""
        if self._begun:
            self._points.append(to)

    def shift(self, to: Step) -> None:
        """Let the line that was drawn last end elsewhere: the tool stands, or goes on."""
        if self._begun and len(self._points) > 1:
            self._points[-1] = to

    def lift(self) -> None:
        """End the stroke that is under way, if any."""
        if self._begun:
            self.strokes[self.up].append(self._stroke())
        self._begun, self._points = None, []

    def flip(self) -> None:
        """Turn the sheet over."""
        self.lift()
        self.up = Face.REVERSE if self.up is Face.FRONT else Face.FRONT

    def _stroke(self) -> Drawn:
        assert self._begun is not None
        tool, speed, force, setting = self._begun
        way = tuple(self._points)
        return Drawn(tool, speed, force, way, setting, self.up, self.imperfection)
