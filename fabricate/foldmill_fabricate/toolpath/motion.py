"""The motion model: how long a machine takes. Estimates and the simulator's clock both use it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill_fabricate.machines import Motion


def move_seconds(lengths: ArrayLike, speed: float, acceleration: float) -> NDArray[np.float64]:
    """Return the time of straight moves from rest to rest, s.

    lengths : (n,) mm; speed : mm/s; acceleration : mm/s². A trapezium of speed, or a triangle where
    the move is too short to reach full speed. Corners are full stops, which is on the safe side.
    """
    length = np.asarray(lengths, float)
    ramp = speed * speed / acceleration
    full = length / speed + speed / acceleration
    seconds: NDArray[np.float64] = np.where(
        length < ramp, 2 * np.sqrt(np.maximum(length, 0) / acceleration), full
    )
    return seconds


def path_seconds(points: ArrayLike, speed: float, motion: Motion) -> float:
    """Return the time along a polyline (n, 2) mm with the tool down, s."""
    steps = np.diff(np.asarray(points, float), axis=0)
    return float(move_seconds(np.hypot(*steps.T), speed, motion.acceleration).sum())
