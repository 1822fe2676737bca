"""Matching notches: as many in both borders of a seam as the seam's number, where it begins.

A notch is a small triangle cut out of the border. Two borders belong together where their notches
face each other, and they make holes like a row of little diamonds when they are glued.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from foldmill import ImpossibleGeometry
from foldmill.axisymmetric.tabs import Joint
from foldmill.axisymmetric.tube import Sheet
from foldmill_plugins.waterbomb.partition import edges_of

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

MOST = 5
"""Notches in one edge: more are not told apart at a glance."""
DEPTH = 0.8
"""Depth of a notch, as a share of its width."""
LEVEL = 1e-9
"""mm². Twice the area below which three places are on one line."""
ROOM = 0.5
"""Share of a facet's height that a notch may take."""


def spread(
    sheet: Sheet,
    joints: Sequence[Joint],
    number: int,
    width: float,
    taken: set[frozenset[int]],
) -> list[int]:
    """Return how many notches each joint of a seam gets, from the first on; in all ``number``.

    taken : the facets that have notches already; those chosen here are added. Raises
    ImpossibleGeometry where the seam has no room for its notches.
    """
    counts: list[int] = []
    for joint in joints:
        sides = {frozenset(joint.host), frozenset(joint.land)}
        room = min(_room(sheet, each, width) for each in (joint.host, joint.land))
        counts.append(0 if sides & taken else min(room, number - sum(counts)))
        taken |= sides if counts[-1] else set()
    if sum(counts) < number:
        raise ImpossibleGeometry(
            f"Seam {number} has {len(joints)} edges and room for {sum(counts)} matching notches "
            f"{width:g} mm wide, not for {number}. Make the notches smaller, the sheet larger or "
            "the pieces fewer; 0 leaves the notches out."
        )
    return counts


def _room(sheet: Sheet, corners: tuple[int, int, int], width: float) -> int:
    """Return how many notches about the middle of the edge a-b stay inside the facet a, b, c."""
    a, b, c = sheet.flat[list(corners)]
    length = float(np.hypot(*(b - a)))
    along = (b - a) / length
    foot = float((c - a) @ along)
    height = abs(float(along[0] * (c - a)[1] - along[1] * (c - a)[0]))
    depth = DEPTH * width
    if depth > ROOM * height:
        return 0
    narrowed = max(depth * foot / height, depth * (length - foot) / height, width / 2)
    return max(0, min(MOST, 1 + int(np.floor((length / 2 - narrowed) / width - 0.5))))


def cut(
    sheet: Sheet, owner: Indices, sides: Sequence[tuple[tuple[int, int, int], int]], width: float
) -> tuple[Sheet, Indices]:
    """Return the sheet with notches, and the pieces (F,) its facets are of.

    owner : (F,) piece of each facet; sides : corners a, b, c of a facet whose border a-b gets so
    many notches.
    """
    flat, spatial = list(sheet.flat), list(sheet.spatial)
    kept = {frozenset(face): (face, owner[f]) for f, face in enumerate(sheet.faces.tolist())}
    new: list[tuple[list[int], int]] = []
    for (a, b, c), count in sides:
        face, piece = kept.pop(frozenset((a, b, c)))
        turn = face.index(a)
        if face[(turn + 1) % 3] != b:
            a, b = b, a
        chain = [a]
        for share, depth in _outline(sheet.flat, (a, b, c), count, width):
            flat.append(_spot(sheet.flat, (a, b, c), share, depth))
            spatial.append(_spot(sheet.spatial, (a, b, c), share, depth))
            chain.append(len(flat) - 1)
        chain.append(b)
        new += [(ear, piece) for ear in _ears(np.array(flat), [*chain, c])]
    rows = [*kept.values(), *new]
    grown = np.array([face for face, _ in rows], np.intp)
    whole = replace(
        sheet,
        flat=np.array(flat),
        spatial=np.array(spatial),
        faces=grown,
        edges=edges_of(grown),
    )
    return whole, np.array([piece for _, piece in rows], np.intp)


def _outline(
    flat: Floats, corners: tuple[int, int, int], count: int, width: float
) -> list[tuple[float, float]]:
    """Return the corners of the notches along an edge: share of its length, depth in mm."""
    a, b, _ = flat[list(corners)]
    length = float(np.hypot(*(b - a)))
    middles = length / 2 + 2 * width * (np.arange(count) - (count - 1) / 2)
    spots = [
        (middle + side * width / 2, DEPTH * width * (side == 0))
        for middle in middles.tolist()
        for side in (-1, 0, 1)
    ]
    return [(along / length, depth) for along, depth in spots]


def _spot(
    points: Floats, corners: tuple[int, int, int], share: float, depth: float
) -> NDArray[np.float64]:
    """Return the place at a share of the edge a-b, ``depth`` inside the facet a, b, c."""
    a, b, c = points[list(corners)]
    along = (b - a) / np.linalg.norm(b - a)
    inward = (c - a) - ((c - a) @ along) * along
    inward = inward / np.linalg.norm(inward)
    spot: Floats = a + share * (b - a) + depth * inward
    return spot


def _ears(flat: Floats, polygon: list[int]) -> list[list[int]]:
    """Return a simple polygon, counter-clockwise, as triangles: ear by ear, the fattest first."""
    left, found = list(polygon), []
    while len(left) > 3:
        turns = [[left[k - 1], left[k], left[(k + 1) % len(left)]] for k in range(len(left))]
        free = [each for each in turns if not _holds_any(flat, each, left)]
        best = max(free, key=lambda each: _fatness(flat[each]))
        found.append(best)
        left.remove(best[1])
    return [*found, left]


def _holds_any(flat: Floats, triangle: list[int], others: list[int]) -> bool:
    rest = flat[[each for each in others if each not in triangle]]
    a, b, c = flat[triangle]
    sides = [_doubled(p, q, rest) for p, q in ((a, b), (b, c), (c, a))]
    return bool((np.min(sides, axis=0) >= -LEVEL).any())


def _doubled(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return twice the signed areas of triangles a, b, c (n, 2)."""
    doubled: Floats = (b - a)[0] * (c - a)[..., 1] - (b - a)[1] * (c - a)[..., 0]
    return doubled


def _fatness(corners: Floats) -> float:
    """Return the area of a triangle (3, 2) as a share of its squared sides, with its sign."""
    sides = np.roll(corners, -1, axis=0) - corners
    return float(_doubled(*corners) / (sides**2).sum())
