"""One form from several sheets: cut apart, with glue tabs and matching notches, one at a time.

The flat sheet is cut along strips and columns; each piece keeps the shape it has in the whole, so
that a whole that lies upon itself, or is too large, becomes pieces that do not and are not.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold, ImpossibleGeometry, InvalidParameters
from foldmill.axisymmetric import tabs
from foldmill.axisymmetric.tube import Sheet
from foldmill.folded import fold_pattern
from foldmill_plugins.waterbomb import notches
from foldmill_plugins.waterbomb.partition import Partition, border_sides, edges_of
from foldmill_plugins.waterbomb.piece_params import MOST, Pieces
from foldmill_plugins.waterbomb.status import Status, overlap, through
from foldmill_plugins.waterbomb.topology import Topology

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FITS = 1e-6
"""mm by which a piece may be larger than its sheet."""


@dataclass(frozen=True, eq=False)
class Whole:
    """A whole sheet before it is cut apart."""

    fold: Fold
    cut: Topology
    origin: Indices
    """(V,) the vertex of the closed topology each vertex comes from."""


@dataclass(frozen=True, eq=False)
class Made:
    """All pieces, in one sheet and with the pieces their facets are of."""

    part: Partition
    sheet: Sheet
    owner: Indices
    """(F,) piece of each facet, from 0."""

    @property
    def count(self) -> int:
        """How many pieces there are."""
        return self.part.columns * self.part.rows

    def outline(self, piece: int) -> Floats:
        """Return the outline (n, 2) of a piece where it lies in the whole sheet, mm."""
        spots: Floats = self.sheet.flat[outline(self.sheet.faces[self.owner == piece])]
        return spots

    def is_simple(self, piece: int) -> bool:
        """Tell whether the outline of a piece meets itself nowhere."""
        import shapely

        return bool(shapely.is_simple(shapely.linearrings(self.outline(piece))))

    def fits(self, sheet: tuple[float, float]) -> bool:
        """Tell whether every piece fits a sheet of this width and height, turned or not."""
        outlines = [self.outline(piece) for piece in range(self.count)]
        sizes = np.array([np.ptp(each @ _upright(each).T, axis=0) for each in outlines])
        return bool((np.sort(sizes, axis=1) <= np.sort(sheet) + FITS).all())


def one_of(whole: Whole, wanted: Pieces, state: Status) -> Fold:
    """Return the piece that is asked for as a fold of its own, with what is wrong with the whole.

    state : of the whole sheet. Raises as ``divided`` and ``piece``.
    """
    found = divided(whole, wanted)
    own = replace(state, is_flat_simple=found.is_simple(min(wanted.piece, found.count) - 1))
    about = {**whole.fold.meta, "status": own.facts(), "pieces": facts(found, wanted.piece)}
    about["designed"] = {**about["designed"], **own.said()}
    if found.count > 1:
        about["designed"]["piece"] = f"{wanted.piece} of {found.count}"
        about["title"] = f"Waterbomb tessellation, piece {wanted.piece} of {found.count}"
    said = (
        *(each for each in whole.fold.findings if each.code != "flat-overlap"),
        *overlap(own),
        *(through(state) if found.count > 1 else ()),
    )
    return replace(piece(found, wanted.piece), findings=said, meta=about)


def divided(whole: Whole, wanted: Pieces) -> Made:
    """Return the pieces as they are asked for, or where they are looked for, the fewest that do.

    Those must not lie upon themselves, and fit the sheet where one is stated. Raises
    ImpossibleGeometry where no number of pieces does, or a tab or notch has no room.
    """
    if not wanted.is_sought:
        return made(whole, wanted, wanted.columns, wanted.rows)
    for columns, rows in _numbers(whole.cut, wanted):
        if not _does(Made(*_bare(whole, columns, rows)), wanted):
            continue
        found = made(whole, wanted, columns, rows)
        if _does(found, wanted):
            return found
    if wanted.sheet is None:
        raise ImpossibleGeometry(
            f"However it is cut into up to {MOST} columns and rows, a piece lies upon itself, with "
            "its tabs and notches. Make tabs and notches smaller, or take another depth."
        )
    width, height = wanted.sheet
    raise ImpossibleGeometry(
        f"Even single bases do not fit a sheet of {width:g} × {height:g} mm, or more than {MOST} "
        "pieces along one side would be needed. Make the form smaller or the sheet larger."
    )


def _does(found: Made, wanted: Pieces) -> bool:
    """Tell whether every piece fits the sheet, where one is stated, and lies flat."""
    fits = wanted.sheet is None or found.fits(wanted.sheet)
    return fits and all(map(found.is_simple, range(found.count)))


def _numbers(cut: Topology, wanted: Pieces) -> Iterator[tuple[int, int]]:
    """Yield columns and rows, the fewest pieces first; of as many, the fewest columns."""
    columns = range(wanted.columns, min(cut.n_u, MOST) + 1)
    rows = range(wanted.rows, min(cut.n_v, MOST) + 1)
    yield from sorted(((c, r) for c in columns for r in rows), key=lambda n: (n[0] * n[1], n[0]))


def made(whole: Whole, wanted: Pieces, columns: int, rows: int) -> Made:
    """Return so many pieces with their tabs and notches."""
    if columns > whole.cut.n_u or rows > whole.cut.n_v:
        raise InvalidParameters(
            f"pieces: {whole.cut.n_u} × {whole.cut.n_v} bases cannot be cut into {columns} × "
            f"{rows} pieces; each needs a base at least."
        )
    part, sheet, owner = _bare(whole, columns, rows)
    counts = _notches(part, wanted)
    marked = [
        (side, count)
        for seam, row in zip(part.seams, counts, strict=True)
        for joint, count in zip(seam.joints, row, strict=True)
        if count
        for side in (joint.host, joint.land)
    ]
    plain = [
        (seam, joint)
        for seam, row in zip(part.seams, counts, strict=True)
        for joint, count in zip(seam.joints, row, strict=True)
        if not count
    ]
    if wanted.tabs > 0:
        sheet = tabs.add_at(sheet, [joint for _, joint in plain], wanted.tabs, wanted.taper).sheet
        owner = np.concatenate([owner, np.repeat([seam.host for seam, _ in plain], 2)])
    return Made(part, *notches.cut(sheet, owner.astype(np.intp), marked, wanted.notch))


def _bare(whole: Whole, columns: int, rows: int) -> tuple[Partition, Sheet, Indices]:
    part = Partition(whole.fold, whole.cut, whole.origin, columns, rows)
    return part, part.sheet, part.piece


def _notches(part: Partition, wanted: Pieces) -> list[list[int]]:
    """Return for each seam how many notches each of its joints gets."""
    none = part.columns * part.rows == 1 or wanted.notch == 0
    taken: set[frozenset[int]] = set()
    return [
        [0] * len(seam.joints)
        if none
        else notches.spread(part.sheet, seam.joints, seam.number, wanted.notch, taken)
        for seam in part.seams
    ]


def piece(found: Made, number: int) -> Fold:
    """Return one piece as a fold of its own; number : from 1.

    Raises InvalidParameters for a number that no piece has.
    """
    if number > found.count:
        raise InvalidParameters(
            f"pieces.piece: there are {found.count} pieces, so none has the number {number}."
        )
    faces = found.sheet.faces[found.owner == number - 1]
    used, renamed = np.unique(faces, return_inverse=True)
    faces = renamed.reshape(-1, 3).astype(np.intp)
    edges, turn = edges_of(faces), _upright(found.outline(number - 1))
    flat = found.sheet.flat[used] @ turn.T
    signs = np.zeros(len(edges), np.intp)
    spatial = found.sheet.spatial[used]
    pattern, form = fold_pattern(flat - flat.min(axis=0), spatial, edges, faces, signs)
    return Fold(pattern, replace(form, seams=_twins(found.part, used)))


def _twins(part: Partition, used: Indices) -> Indices:
    """Return the pairs (S, 2) among a piece's vertices that are one in space."""
    return twins(part.origin[part.of[used[used < len(part.of)]]])


def twins(origin: Indices) -> Indices:
    """Return the pairs (S, 2) of places with the same number in origin (n,)."""
    order = np.argsort(origin, kind="stable")
    first = np.concatenate([[True], np.diff(origin[order]) > 0])
    leader = order[np.maximum.accumulate(np.where(first, np.arange(len(order)), 0))]
    pairs: Indices = np.column_stack([leader[~first], order[~first]])
    return pairs


def outline(faces: Indices) -> Indices:
    """Return the border of facets (F, 3) as a loop of vertices (n,)."""
    after = {a: b for _, a, b, _ in border_sides(faces)}
    start = min(after)
    loop = [start]
    while after[loop[-1]] != start:
        loop.append(after[loop[-1]])
    return np.array(loop, np.intp)


def _upright(spots: Floats) -> Floats:
    """Return the turn (2, 2) after which the box about places (n, 2) is smallest and lies wide."""
    import shapely

    box = np.asarray(shapely.oriented_envelope(shapely.multipoints(spots)).exterior.coords)
    sides = np.diff(box[:3], axis=0)
    x, y = sides[np.hypot(*sides.T).argmax()]
    if x < 0 or (x == 0 and y < 0):
        x, y = -x, -y
    c, s = x / np.hypot(x, y), y / np.hypot(x, y)
    return np.array([[c, s], [-s, c]])


def facts(found: Made, number: int) -> dict[str, Any]:
    """Return for people which piece this is and which of its borders meets which piece."""
    seams = [
        {
            "seam": seam.number,
            "meets": (seam.land if seam.host == number - 1 else seam.host) + 1,
            "tabs": "here" if seam.host == number - 1 else "there",
            "edges": len(seam.joints),
        }
        for seam in found.part.seams
        if number - 1 in (seam.host, seam.land)
    ]
    return {
        "piece": number,
        "of": found.count,
        "columns": found.part.columns,
        "rows": found.part.rows,
        "seams": seams,
    }
