"""Words as single strokes, from a small alphabet of our own that lies beside the code."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

RISE = 6.0
"""Height of capitals on the alphabet's grid."""
ADVANCE = 6.0
"""From one letter to the next on the alphabet's grid."""


@cache
def _alphabet() -> dict[str, tuple[tuple[tuple[int, int], ...], ...]]:
    text = (files("foldmill_fabricate") / "letters.toml").read_text(encoding="utf-8")
    return {
        letter: tuple(
            tuple((int(point[0]), int(point[1])) for point in stroke.split())
            for stroke in drawn.split(";")
        )
        for letter, drawn in tomllib.loads(text).items()
    }


def strokes(text: str, height: float) -> list[Floats]:
    """Return the strokes (n, 2) of a line of words, mm, its baseline beginning at 0, 0.

    Small letters are drawn as capitals; what the alphabet has no letter for is left blank.
    """
    scale = height / RISE
    return [
        (np.array(stroke, float) + np.array([ADVANCE * place, 0.0])) * scale
        for place, letter in enumerate(text.upper())
        for stroke in _alphabet().get(letter, ())
    ]


def width(text: str, height: float) -> float:
    """Return how long a line of words is, mm, with the space after its last letter."""
    return ADVANCE * len(text) * height / RISE
