"""The motion model: how long a machine takes. Estimates and the simulator's clock both use it.

With the tool down a machine looks ahead along the stroke. It goes round a corner as fast as leaves
its velocity changed by no more than ``corner_speed``, and speeds up and brakes evenly in between;
straight on it does not slow down at all. Strokes and pen-up moves begin and end at rest.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, floor, fsum, hypot, inf, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill_fabricate.machines import Machine, Motion


def move_seconds(lengths: ArrayLike, speed: float, acceleration: float) -> NDArray[np.float64]:
    """Return the time of straight moves from rest to rest, s.

    lengths : (n,) mm; speed : mm/s; acceleration : mm/s². A trapezium of speed, or a triangle where
    the move is too short to reach full speed.
    """
    length = np.asarray(lengths, float)
    ramp = speed * speed / acceleration
    full = length / speed + speed / acceleration
    seconds: NDArray[np.float64] = np.where(
        length < ramp, 2 * np.sqrt(np.maximum(length, 0) / acceleration), full
    )
    return seconds


def hop_seconds(length: float, speed: float, acceleration: float) -> float:
    """Return the same of one move, for loops that have one at a time."""
    if length < speed * speed / acceleration:
        return 2 * sqrt(length / acceleration)
    return length / speed + speed / acceleration


def path_seconds(points: ArrayLike, speed: float, motion: Motion) -> float:
    """Return the time along a polyline (n, 2) mm with the tool down, s."""
    pace = Pace(motion)
    steps = np.diff(np.asarray(points, float), axis=0).tolist()
    # the same in every Python, as sum is not: from 3.12 on that makes up for its rounding
    return fsum(pace.go_on(dx, dy, speed) for dx, dy in steps)


def told_speed(speed: float, machine: Machine) -> float:
    """Return how fast a machine goes that is asked for a speed, mm/s.

    VS counts whole cm/s; a machine that does not know it goes at its own speed.
    """
    if not machine.dialect.speed:
        return machine.motion.travel_speed
    return 10.0 * max(1, floor(speed / 10 + 0.5))


@dataclass
class _Piece:
    """A straight piece of a stroke; speeds in mm/s."""

    length: float
    speed: float
    """asked for"""
    reachable: float
    """with which it may begin, by what comes before and the corner there"""
    entry: float
    """with which it begins, as things stand"""
    seconds: float


@dataclass
class Pace:
    """The time along a stroke that becomes known piece by piece.

    Each piece is charged what the stroke to its end takes longer than the stroke did before. So the
    sum is the time of the whole stroke, whoever adds it up and when.
    """

    motion: Motion
    _pieces: list[_Piece] = field(default_factory=list)
    _course: float = 0.0

    def stop(self) -> None:
        """Come to rest: the next piece begins a new stroke."""
        self._pieces.clear()

    def go_on(self, dx: float, dy: float, speed: float) -> float:
        """Return what going on by (dx, dy) mm adds to the stroke's time, s; speed : mm/s."""
        length = hypot(dx, dy)
        if not length:
            return 0.0
        course = atan2(dy, dx)
        reachable = self._corner(course, speed) if self._pieces else 0.0
        self._course = course
        self._pieces.append(_Piece(length, speed, reachable, 0.0, 0.0))
        return self._brake()

    def _corner(self, course: float, speed: float) -> float:
        """Return how fast the corner before a new piece can be passed."""
        last = self._pieces[-1]
        chord = 2 * abs(sin((course - self._course) / 2))
        most = self.motion.corner_speed / chord if chord > 1e-12 else inf
        gained = sqrt(last.reachable**2 + 2 * self.motion.acceleration * last.length)
        return min(most, last.speed, speed, gained)

    def _brake(self) -> float:
        """Work out again, from the end backwards, what braking for the new end changes."""
        gain, leaving = 0.0, 0.0
        for k in range(len(self._pieces) - 1, -1, -1):
            piece = self._pieces[k]
            before = piece.entry
            braking = sqrt(leaving**2 + 2 * self.motion.acceleration * piece.length)
            piece.entry = min(piece.reachable, braking)
            seconds = self._seconds(piece, leaving)
            gain += seconds - piece.seconds
            piece.seconds = seconds
            leaving = piece.entry
            if piece.entry == before and k < len(self._pieces) - 1:
                del self._pieces[: max(0, k - 1)]  # nothing before can change any more
                break
        return gain

    def _seconds(self, piece: _Piece, leaving: float) -> float:
        """Return the time from one speed up to another and down to a third."""
        a, entry = self.motion.acceleration, piece.entry
        peak = min(piece.speed, sqrt((entry**2 + leaving**2) / 2 + a * piece.length))
        ramps = (2 * peak**2 - entry**2 - leaving**2) / (2 * a)
        return (2 * peak - entry - leaving) / a + (piece.length - ramps) / peak
