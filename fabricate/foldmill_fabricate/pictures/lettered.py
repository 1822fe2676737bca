"""The folded form with a letter at each kind of crease that is seen on it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold
from foldmill_fabricate.pictures.render import Camera, form_of, render, spots

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

TRIED = 24
"""Creases of a kind that are looked at for one that is seen."""


def draw_lettered(
    axes: Axes,
    fold: Fold,
    camera: Camera,
    letters: Mapping[str, Indices],
    pixels: int = 460,
    size: float = 6.5,
) -> None:
    """Draw the folded form into axes, each letter on one of its edges that is seen from there.

    letters : edges (k,) of the pattern by letter; size : of the letters, points. Raises
    InvalidInput where the fold has no folded form.
    """
    image = render(fold, camera, pixels)
    axes.imshow(image, interpolation="none", extent=(0, 1, 0, 1))
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)
    frame = {"boxstyle": "circle,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
    for letter, (x, y) in placed(fold, camera, letters).items():
        axes.text(x, y, letter, ha="center", va="center", fontsize=size, bbox=frame)


def placed(fold: Fold, camera: Camera, letters: Mapping[str, Indices]) -> dict[str, Floats]:
    """Return where letters stand in the picture, (2,) shares of its side: apart from each other.

    A kind of crease that is hidden from the camera has no place.
    """
    form, edges = form_of(fold).vertices, fold.pattern.edges
    some = [every[:: max(1, len(every) // TRIED)] for every in letters.values()]
    owners = np.repeat(np.arange(len(some)), [len(each) for each in some])
    middles = form[edges[np.concatenate(some)]].mean(axis=1) if some else np.zeros((0, 3))
    looked = spots(fold, camera, middles)
    taken: list[Floats] = []
    found: dict[str, Floats] = {}
    for k, letter in enumerate(letters):
        seen = [looked[j].at for j in np.flatnonzero(owners == k) if looked[j].seen]
        if seen:
            rooms = [_room(at, taken) for at in seen]
            found[letter] = seen[int(np.argmax(np.round(rooms, 6)))]
            taken.append(found[letter])
    return found


def _room(at: Floats, taken: list[Floats]) -> float:
    """Return how good a place is: far from other letters, and near the picture's middle."""
    nearest = min((float(np.hypot(*(at - other))) for other in taken), default=1.0)
    return min(nearest, 0.12) - 0.2 * float(np.hypot(*(at - 0.5)))
