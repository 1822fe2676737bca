"""Random crease patterns, and how two of them are compared whatever the order of their lines."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from foldmill import CreasePattern, Fold

SIDE = 20.0
"""mm between neighbouring vertices."""
Known = tuple[tuple[float, float], tuple[float, float], str, float]


@st.composite
def folds(draw: st.DrawFn, letters: str = "MVF", partly: bool = False) -> Fold:
    """Draw a sheet of bent squares, some of them halved; its inner lines have any of the letters.

    partly : whether mountains and valleys fold by any angle, not only flat.
    """
    nx, ny = draw(st.integers(1, 4)), draw(st.integers(1, 4))
    shift = st.floats(-0.2, 0.2)
    points = [
        [round(SIDE * (x + draw(shift)), 2), round(SIDE * (y + draw(shift)), 2)]
        for y in range(ny + 1)
        for x in range(nx + 1)
    ]
    edges, border = _grid(nx, ny, draw(st.lists(st.booleans(), min_size=16, max_size=16)))
    given = ["B" if each else draw(st.sampled_from(letters)) for each in border]
    share = st.integers(1, 180) if partly else st.just(180)
    angles = [{"M": -1.0, "V": 1.0}.get(letter, 0.0) * draw(share) for letter in given]
    return Fold(CreasePattern.from_lines(points, edges, "".join(given), angles))


def _grid(nx: int, ny: int, halved: list[bool]) -> tuple[list[list[int]], list[bool]]:
    row = nx + 1
    edges, border = [], []
    for y in range(ny + 1):
        for x in range(nx + 1):
            at = y * row + x
            if x < nx:
                edges.append([at, at + 1])
                border.append(y in {0, ny})
            if y < ny:
                edges.append([at, at + row])
                border.append(x in {0, nx})
            if x < nx and y < ny and halved[(y * nx + x) % len(halved)]:
                edges.append([at, at + row + 1])
                border.append(False)
    return edges, border


def lines_of(fold: Fold, digits: int = 6, of_angles: int = 6) -> set[Known]:
    """Return every line that is not added: its ends, mm from the lower left corner; what it is.

    digits, of_angles : how many decimals of places and of fold angles are kept.
    """
    pattern = fold.pattern
    places = np.round(pattern.vertices - pattern.vertices.min(axis=0), digits) + 0.0
    angles = np.round(pattern.fold_angles, of_angles) + 0.0
    known: set[Known] = set()
    for k in np.flatnonzero(~np.asarray(pattern.added, bool)).tolist():
        (x0, y0), (x1, y1) = sorted(places[pattern.edges[k]].tolist())
        known.add(((x0, y0), (x1, y1), pattern.letters()[k], float(angles[k])))
    return known
