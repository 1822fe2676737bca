"""Lead a machine about with its tool up: round a job's box, by some mm, above a mark.

Every hop is a program of its own: written here, checked like all that is sent, proved to keep the
tool up and within the machine's limits, and confirmed by the machine where it can before the next
one leaves. So it goes slowly, and stops within a hop.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from math import ceil, hypot, isfinite, radians, tan
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.formats import gcode, hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.marks import targets
from foldmill_fabricate.passes import XY, Face, Fit, Plan
from foldmill_fabricate.plotter import sender
from foldmill_fabricate.plotter.sender import Status
from foldmill_fabricate.plotter.standing import stand
from foldmill_fabricate.sheet import seen_by_machine
from foldmill_fabricate.toolpath.ways import ways
from foldmill_fabricate.verify.pen_up import prove_pen_up

Floats = NDArray[np.float64]

HOP = 20.0
"""mm that are gone at once: a machine that stops after each is slow, whatever speed it takes."""

_SLACK = 1e-9
"""mm"""


@dataclass
class Jogger:
    """A machine that is led about."""

    port: Any
    machine: Machine
    at: XY | None = None
    """Where its tool is, carrier coordinates in mm; None until it was sent anywhere, or asked."""
    _begun: bool = False

    def ask(self) -> XY:
        """Ask the machine where its tool is; raises CannotSend where it cannot say."""
        found = stand(self.port, self.machine)
        if found is None:
            raise CannotSend(
                f"{self.machine.slug} cannot say where its tool stands, so that nobody knows what "
                "is within its limits. Move it with its own keys."
            )
        self.at = carrier(found.at, self.machine)
        return self.at

    def go(self, to: XY) -> None:
        """Go there, carrier coordinates in mm; raises CannotSend for a place beyond the limits.

        Nothing moves then. A machine that cannot say where it stands goes the whole way at once.
        """
        self.refuse(to)
        if self.at is None:
            found = stand(self.port, self.machine)
            self.at = carrier(found.at, self.machine) if found else None
        for spot in [to] if self.at is None else _hops(self.at, to):
            if self._beyond(spot) <= _SLACK:  # it may come from beyond, where it was switched on
                self._hop(spot)
                self.at = spot

    def by(self, dx: float, dy: float) -> None:
        """Go on by so many mm."""
        x, y = self.at or self.ask()
        self.go((x + dx, y + dy))

    def refuse(self, to: XY) -> None:
        """Raise CannotSend, or DoesNotFit, for a place beyond the limits, carrier, mm."""
        if not all(map(isfinite, to)):
            raise CannotSend(f"({to[0]:g}, {to[1]:g}) mm is no place; nothing moved.")
        move(to, self.machine)  # raises where the firmware's own range ends
        over = self._beyond(to)
        if over > _SLACK:
            (left, lead), (right, trail) = self._limits
            raise CannotSend(
                f"({to[0]:.2f}, {to[1]:.2f}) mm is {over:.2f} mm beyond what {self.machine.slug} "
                f"reaches, ({left:g}, {lead:g}) to ({right:g}, {trail:g}) mm; nothing moved."
            )

    @property
    def _limits(self) -> tuple[XY, XY]:
        bed = self.machine.bed
        left, lead, right, trail = bed.margins
        return (left, lead), (bed.width - right, bed.length - trail)

    def _beyond(self, to: XY) -> float:
        """Return how far a place is beyond the limits, mm; not above 0 within."""
        low, high = self._limits
        return max(max(a - b, b - c) for a, b, c in zip(low, to, high, strict=True))

    def _hop(self, to: XY) -> None:
        data = move(to, self.machine, first=not self._begun)
        errors = prove_pen_up(data, self.machine)
        if errors:
            raise CannotSend(f"The move is not sent, for it does not verify: {errors[0]}")
        delivery = sender.send(data, self.port, self.machine)
        self._begun = True
        if delivery.status is Status.FAULT:
            raise CannotSend(f"The machine did not get there. {delivery.fault}")


def move(to: XY, machine: Machine, *, first: bool = True) -> bytes:
    """Return the program that goes to a place, carrier coordinates in mm, with the tool up.

    first : whether nothing was sent before; only then it begins the machine anew. Raises CannotSend
    for a machine whose language has no word for where it stands, DoesNotFit beyond its range.
    """
    ((x, y),) = hpgl.steps([to], machine.axes, "The way").tolist()
    if machine.language == "gcode":
        return gcode.travel((x, y), machine)
    if machine.language != "hpgl":
        raise CannotSend(
            f"{machine.slug} speaks {machine.language}, in which nobody can lead it about safely: "
            "it does not say where it stands. Move it with its own keys."
        )
    begin = machine.dialect.preamble if first else "PA;"
    return "".join(line + machine.dialect.line_end for line in (begin, f"PU{x},{y};")).encode()


def carrier(steps: XY, machine: Machine) -> XY:
    """Return the carrier coordinates of machine steps, mm; the inverse of what a writer does."""
    axes = machine.axes
    x, y = (value / axes.units_per_mm for value in (steps[::-1] if axes.swap else steps))
    up = y / axes.scale_y
    return x / axes.scale_x - up * tan(radians(axes.skew)), up


def box(plan: Plan, fit: Fit | None = None, faces: Sequence[Face] = (Face.FRONT,)) -> Floats:
    """Return the corners (4, 2) of all that is drawn on faces, carrier coordinates in mm."""
    drawn = np.vstack(
        [
            way.points
            for work in plan.passes
            if work.face in faces
            for setup in work.setups
            for way in ways(setup, plan.machine, partial(_seen, plan, work.face, fit))
        ]
    )
    (x, y), (u, v) = drawn.min(axis=0), drawn.max(axis=0)
    return np.array([[x, y], [u, y], [u, v], [x, v]])


def frame(jogger: Jogger, corners: Floats, tell: Callable[[XY], None] = lambda _: None) -> None:
    """Go round a box (4, 2), mm, back to its first corner; all corners are checked first."""
    way = [(float(x), float(y)) for x, y in [*corners, corners[0]]]
    for corner in way:
        jogger.refuse(corner)
    for corner in way:
        jogger.go(corner)
        tell(corner)


def expected_marks(plan: Plan, fit: Fit | None = None) -> list[XY]:
    """Return where the registration marks of the flipped sheet are to be looked for, mm.

    Raises CannotSend for a job that has none, or whose machine searches them by itself.
    """
    goal = targets(plan)
    if plan.registration.kind == "l-marks":
        raise CannotSend(
            f"{plan.machine.slug} finds these marks with its own sensor: let it search them."
        )
    if not len(goal) or len(plan.passes) < 2:
        raise CannotSend("This job has no registration holes to measure.")
    return [(float(x), float(y)) for x, y in seen_by_machine(plan, Face.REVERSE, goal, fit)]


def _seen(plan: Plan, face: Face, fit: Fit | None, points: ArrayLike) -> Floats:
    return seen_by_machine(plan, face, points, fit)


def _hops(start: XY, end: XY) -> Iterator[XY]:
    count = max(1, ceil(hypot(end[0] - start[0], end[1] - start[1]) / HOP))
    for k in range(1, count):
        share = k / count
        yield start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])
    yield end
