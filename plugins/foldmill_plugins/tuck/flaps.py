"""Flaps in a half wedge: their facets, the creases that close, and how their halves are stacked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.rosette import EdgeSigns, HalfWedge, Rosette, Seat
from foldmill_plugins.tuck.blanks import Blank
from foldmill_plugins.tuck.clearance import flap_faces
from foldmill_plugins.tuck.search import Placed

Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Flap:
    """Where a blank's flap stands among the half wedge's points and faces."""

    blank: Blank
    corners: tuple[int, ...]
    """Numbers of its corners among the half wedge's points."""
    faces: Indices
    """Numbers of its facets among the half wedge's faces."""

    @property
    def spine(self) -> tuple[int, ...]:
        """Numbers of A, the corners, and B where there is one: all creases between fold ±180."""
        chain = self.blank.chain
        return (chain[0], *self.corners, *(() if self.blank.is_open else chain[-1:]))


def add(half: HalfWedge, blanks: list[Blank]) -> tuple[HalfWedge, list[Flap]]:
    """Return the half wedge with a flap in each blank, and the flaps; no corner is placed yet."""
    faces: list[list[int]] = half.faces.tolist()
    seats, flaps = list(half.seats), []
    count = len(half.flat)
    for blank in blanks:
        corners = tuple(range(count, count + len(blank.points)))
        numbers = np.array([*blank.chain, *corners], np.intp)
        facets = numbers[flap_faces(blank)]
        # Counter-clockwise from above, on whichever side of its line the half wedge lies.
        facets = facets if blank.first % 2 == 0 else facets[:, ::-1]
        flaps.append(Flap(blank, corners, np.arange(len(faces), len(faces) + len(facets))))
        faces += facets.tolist()
        seats += [Seat.L2 if blank.first % 2 == 0 else Seat.L1] * len(corners)
        count += len(corners)
    spare = count - len(half.flat)
    return replace(
        half,
        flat=np.vstack([half.flat, np.zeros((spare, 2))]),
        spatial=np.vstack([half.spatial, np.zeros((spare, 3))]),
        seats=tuple(seats),
        faces=np.array(faces, np.intp).reshape(-1, 3),
    ), flaps


def put(rose: Rosette, flaps: list[Flap], placed: list[Placed]) -> Rosette:
    """Return the form with the flaps' corners in their places."""
    flat, spatial = rose.half.flat.copy(), rose.half.spatial.copy()
    for flap, each in zip(flaps, placed, strict=True):
        flat[list(flap.corners)] = each.corners.t[0][:, None] * flap.blank.along
        spatial[list(flap.corners)] = each.corners.spots[0]
    return rose.moved(replace(rose.half, flat=flat, spatial=spatial))


def closed(flap: Flap, side: int) -> EdgeSigns:
    """Return the signs, seen from above, of the creases of a flap that fold to ±180.

    Those on the symmetry line are valleys where the flap lies below (``side`` 1). A seam's crease
    can also close, where the flap lies flush upon the surface: it folds back what they fold.
    """
    chain, spine = flap.blank.chain, flap.spine
    signs = {_pair(a, b): -side for a, b in pairwise(chain)}
    return signs | {_pair(a, b): side for a, b in pairwise(spine)}


def _pair(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a < b else (b, a)


def orders(rose: Rosette, flap: Flap, sign: int) -> list[list[int]]:
    """Return FOLD's faceOrders [f, g, s] for the two halves of a flap in every wedge.

    sign : 1 where their fronts face each other (the spine is a valley): each lies on the side to
    which the other's normal points; -1 where their backs do.
    """
    half, wedge = len(rose.half.faces), 2 * len(rose.half.faces)
    # The mirror image of a half wedge about l2 belongs to the next wedge.
    across = half if flap.blank.first % 2 else half + wedge
    return [
        [start + int(face), (start + int(face) + across) % len(rose.faces), sign]
        for start in range(0, len(rose.faces), wedge)
        for face in flap.faces
    ]
