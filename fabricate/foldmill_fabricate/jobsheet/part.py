"""The part of a pattern that is drawn enlarged, so that the angle of each crease can be read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern, Fold
from foldmill_fabricate.jobsheet.creases import Arrangement, middle
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.pictures.pattern import PRINTED
from foldmill_fabricate.sheet import turned

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

MOST = 90
"""Creases in a part: more would not be told apart."""
SLIM = 6.0
"""Times longer than wide: a column of a strip that is slimmer is not drawn whole."""
_WORDS, _LETTER = 11.0, 3.5
"""mm on paper: shorter creases have no room for letter and angle; for a letter."""
_LITTLE = 1e-6
"""Share of the pattern's size."""


@dataclass(frozen=True, eq=False)
class Part:
    """Some edges of a pattern, turned as they are drawn."""

    title: str
    edges: Indices
    """(k,) into the pattern's edges."""
    vertices: Floats
    """(V, 2) mm, of the whole pattern."""


def part(fold: Fold, how: Arrangement) -> Part:
    """Return one of the equal parts of a pattern that repeats, else what lies round its middle."""
    pattern, symmetry = fold.pattern, fold.symmetry
    every = np.arange(len(pattern.edges))
    if symmetry is not None and symmetry.order > 1 and len(symmetry.wedge):
        cut = _sector if how.kind == "rings" else _column if how.kind == "rows" else None
        found = cut(pattern, symmetry.order, symmetry.wedge) if cut else None
        if found is not None and len(found.edges) <= MOST:
            return found
    if len(pattern.edges) <= MOST:
        return Part("Fold angles of the pattern", every, pattern.vertices)
    away = np.abs(pattern.vertices[pattern.edges].mean(axis=1) - middle(pattern)).max(axis=1)
    nearest = np.sort(np.argsort(np.round(away, 6), kind="stable")[:MOST])
    return Part("Fold angles round the middle", nearest, pattern.vertices)


def draw(
    axes: Axes,
    pattern: CreasePattern,
    shown: Part,
    how: Arrangement,
    paper: tuple[float, float],
) -> None:
    """Draw a part into axes, each crease with its letter and angle.

    paper : width and height of the axes, mm. What is flat is drawn as far as the creases reach.
    """
    ends = shown.vertices[pattern.edges[shown.edges]]
    kinds = pattern.assignments[shown.edges]
    for kind, look in PRINTED.items():
        if (kinds == kind).any():
            style = {"color": look.colour, "linewidth": look.width, "linestyle": look.style}
            canvas.add_lines(axes, ends[kinds == kind], **style)
    scale = _frame(
        axes, ends[kinds != Assignment.F] if (kinds != Assignment.F).any() else ends, paper
    )
    letters = {int(edge): group.letter for group in how.groups for edge in group.edges}
    for edge, (one, two) in zip(shown.edges.tolist(), ends, strict=True):
        if edge in letters:
            _label(axes, letters[edge], abs(pattern.fold_angles[edge]), one, two, scale)


def _frame(axes: Axes, ends: Floats, paper: tuple[float, float]) -> float:
    """Make the axes show these edges (k, 2, 2) as large as can be; return paper mm per mm."""
    low, high = ends.reshape(-1, 2).min(axis=0), ends.reshape(-1, 2).max(axis=0)
    size = np.maximum(high - low, _LITTLE * (high - low).max())
    margin = 0.03 * float(size.max())
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    return float((np.array(paper) / (size + 2 * margin)).min())


def _label(axes: Axes, letter: str, angle: float, one: Floats, two: Floats, scale: float) -> None:
    room = float(np.hypot(*(two - one))) * scale
    if room < _LETTER:
        return
    words = f"{letter} {angle:.0f}°" if room >= _WORDS else letter
    slope = float(np.degrees(np.arctan2(*(two - one)[::-1])))
    upright = (slope + 90) % 180 - 90
    frame = {"boxstyle": "square,pad=0.08", "facecolor": "white", "edgecolor": "none"}
    x, y = (one + two) / 2
    axes.text(
        x, y, words, rotation=round(upright, 3), rotation_mode="anchor", ha="center",
        va="center_baseline" if room >= _WORDS else "center", fontsize=7.5, bbox=frame,
    )  # fmt: skip


def _sector(pattern: CreasePattern, order: int, wedge: Indices) -> Part:
    """Return one wedge of a pattern round its middle, pointing upward."""
    centre, wide = middle(pattern), 360.0 / order
    corners = pattern.vertices[np.unique(pattern.faces[wedge])] - centre
    far = corners[np.hypot(*corners.T) > _LITTLE * pattern.size]
    heading = float(np.degrees(np.arctan2(*far.sum(axis=0)[::-1])))
    off = (np.degrees(np.arctan2(far[:, 1], far[:, 0])) - heading + 180) % 360 - 180
    begin = heading + float(off.min())
    upright = turned(pattern.vertices - centre, 90 - begin - wide / 2)
    x, y = upright[pattern.edges].mean(axis=1).T
    lean = np.abs(np.degrees(np.arctan2(x, y)))
    inside = (lean <= wide / 2 + 1e-3) | (np.hypot(x, y) <= _LITTLE * pattern.size)
    found = np.flatnonzero(inside)
    return Part(f"One of {order} equal parts, enlarged, with fold angles", found, upright)


def _column(pattern: CreasePattern, order: int, wedge: Indices) -> Part | None:
    """Return one column of a strip, or one row where it runs upward; None where it is too slim."""
    corners = pattern.vertices[np.unique(pattern.faces[wedge])]
    k = int(np.argmin(np.ptp(corners, axis=0) / np.ptp(pattern.vertices, axis=0)))
    begin, end = corners[:, k].min(), 2 * corners[:, k].max() - corners[:, k].min()
    places = pattern.vertices[pattern.edges].mean(axis=1)[:, k]
    little = _LITTLE * pattern.size
    found = np.flatnonzero((places >= begin - little) & (places <= end + little))
    size = np.ptp(pattern.vertices[pattern.edges[found]].reshape(-1, 2), axis=0)
    if not len(found) or size.max() > SLIM * size.min():
        return None
    return Part(f"One of {order} equal parts, enlarged, with fold angles", found, pattern.vertices)
