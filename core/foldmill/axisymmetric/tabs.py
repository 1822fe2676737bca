"""Glue tabs along a seam: one trapezium at each edge of one border, lying upon the other border.

A tab grows in the pattern from an edge of the one border (its host facet). In space it is in the
plane of the facet across the seam and inside it, so that it can be glued there: its crease folds as
that seam would if it were a crease. Its ends lean inwards by the taper, or by more where the facet
it lies upon is narrower; so it never sticks out, and tabs never meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.tube import Sheet
from foldmill.errors import ImpossibleGeometry, InvalidParameters
from foldmill.tolerances import COINCIDENT_MM

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Joint:
    """A seam edge a-b with the facet that holds the tab and the one the tab lies upon."""

    host: tuple[int, int, int]
    """a, b and the third corner of the host facet."""
    land: tuple[int, int, int]
    """The partners of a and b, and the third corner of the facet across the seam."""


@dataclass(frozen=True, eq=False)
class Tabs:
    """The tabs of a sheet: two new vertices each, fixed to their host facets."""

    sheet: Sheet
    """The sheet with its tabs; old vertices keep their numbers."""
    hosts: Indices
    """(k, 3) the corners of the host facet of each new vertex."""
    local: Floats
    """(k, 3) its place in the frame of that facet, mm."""

    def carry(self, spatial: Floats) -> Floats:
        """Return old vertices (V, 3) followed by the new ones, each rigid with its host facet."""
        corners = spatial[self.hosts]
        moved = corners[:, 0] + np.einsum("ki,kij->kj", self.local, _frames(corners))
        return np.vstack([spatial, moved])


def add(sheet: Sheet, width: float, taper: float) -> Tabs:
    """Add a tab at every edge of the second border of the seam.

    width : mm; taper : deg by which each end leans inwards, 0 for a rectangle.
    Raises ImpossibleGeometry where a tab does not fit upon the facet across the seam, and
    InvalidParameters for one without a width.
    """
    return add_at(sheet, _joints(sheet), width, taper)


def add_at(sheet: Sheet, joints: Sequence[Joint], width: float, taper: float) -> Tabs:
    """Add a tab at each of some seam edges, whatever seams they are of; as ``add``."""
    rooms = [_room(sheet, joint, taper) for joint in joints]
    _refuse(rooms, width, taper)
    if not joints:
        return Tabs(sheet, np.zeros((0, 3), np.intp), np.zeros((0, 3)))
    flat, spatial = [sheet.flat], [sheet.spatial]
    faces: list[tuple[int, int, int]] = []
    edges: list[tuple[int, int]] = []
    for k, (joint, room) in enumerate(zip(joints, rooms, strict=True)):
        a, b, _ = joint.host
        c = len(sheet.flat) + 2 * k
        ends = width * room.start, room.length - width * room.end
        flat.append(_beside(sheet.flat[list(joint.host)], ends, -width))
        spatial.append(_beside(sheet.spatial[list(joint.land)], ends, width))
        faces += [(a, c, b), (b, c, c + 1)]
        edges += [(a, c), (b, c), (b, c + 1), (c, c + 1)]
    grown = replace(
        sheet,
        flat=np.vstack(flat),
        spatial=np.vstack(spatial),
        edges=np.vstack([sheet.edges, np.array(edges, np.intp)]),
        faces=np.vstack([sheet.faces, _counter_clockwise(np.vstack(flat), faces)]),
    )
    hosts = np.repeat(np.array([joint.host for joint in joints], np.intp), 2, axis=0)
    corners = sheet.spatial[hosts]
    steps = grown.spatial[len(sheet.flat) :] - corners[:, 0]
    return Tabs(grown, hosts, np.einsum("kj,kij->ki", steps, _frames(corners)))


def _joints(sheet: Sheet) -> list[Joint]:
    """Return the edges whose ends both have a partner across the seam, in order along it."""
    first, second = sheet.seams.T
    partner = dict(zip(second.tolist(), first.tolist(), strict=True))
    third = {
        frozenset(face[:k] + face[k + 1 :]): face[k]
        for face in sheet.faces.tolist()
        for k in range(3)
    }
    found = []
    for a, b in zip(second[:-1].tolist(), second[1:].tolist(), strict=True):
        land = partner[a], partner[b]
        found.append(Joint((a, b, third[frozenset((a, b))]), (*land, third[frozenset(land)])))
    return found


@dataclass(frozen=True)
class _Room:
    """What a seam edge leaves for a tab."""

    length: float
    """Of the edge, mm."""
    start: float
    """By how much each mm of width shortens the tab at a."""
    end: float
    """The same at b."""

    @property
    def widest(self) -> float:
        """At this width a tab comes to a point, mm: never more than the facet across is high."""
        return self.length / (self.start + self.end)


def _room(sheet: Sheet, joint: Joint, taper: float) -> _Room:
    a, b, apex = sheet.flat[list(joint.land)]
    length = float(np.hypot(*(b - a)))
    along = (b - a) / length
    foot = float((apex - a) @ along)
    height = abs(float(along[0] * (apex - a)[1] - along[1] * (apex - a)[0]))
    lean = float(np.tan(np.radians(taper)))
    return _Room(length, max(lean, foot / height), max(lean, (length - foot) / height))


def _refuse(rooms: list[_Room], width: float, taper: float) -> None:
    if width <= COINCIDENT_MM:
        raise InvalidParameters(f"A glue tab {width:g} mm wide holds nothing; make it wider.")
    if not rooms:
        return
    tightest = min(rooms, key=lambda room: room.widest)
    if tightest.length - width * (tightest.start + tightest.end) <= COINCIDENT_MM:
        raise ImpossibleGeometry(
            f"A glue tab {width:g} mm wide does not fit at the seam edge that is "
            f"{tightest.length:.4g} mm long: with a taper of {taper:g}° it must be narrower than "
            f"{tightest.widest:.4g} mm. Make the tabs narrower."
        )


def _beside(corners: Floats, ends: tuple[float, float], width: float) -> Floats:
    """Return the two spots at ``ends`` along the first side, ``width`` towards the third corner."""
    along, across = _frames(corners[None])[0, :2] if corners.shape[1] == 3 else _plane(corners)
    return np.array([corners[0] + end * along + width * across for end in ends])


def _plane(corners: Floats) -> tuple[Floats, Floats]:
    along = (corners[1] - corners[0]) / np.hypot(*(corners[1] - corners[0]))
    across = np.array([-along[1], along[0]])
    return along, across * np.sign(across @ (corners[2] - corners[0]))


def _frames(corners: Floats) -> Floats:
    """Return (k, 3, 3) for facets (k, 3, 3): along the first side, across it inwards, normal."""
    along = corners[:, 1] - corners[:, 0]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    normal = np.cross(along, corners[:, 2] - corners[:, 0])
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    return np.stack([along, np.cross(normal, along), normal], axis=1)


def _counter_clockwise(flat: Floats, faces: list[tuple[int, int, int]]) -> Indices:
    turned = []
    for a, b, c in faces:
        (x1, y1), (x2, y2) = flat[b] - flat[a], flat[c] - flat[a]
        turned.append((a, b, c) if x1 * y2 > x2 * y1 else (a, c, b))
    return np.array(turned, np.intp)
