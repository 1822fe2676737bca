"""From a planar graph of lines to one sheet: loose ends, what is outline and what is inner cut.

A drawing says "cut" or "outline" of a line; only the paper beside it tells which it is. A line with
paper on one side is outline, one with paper on both is an inner cut.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from foldmill import planar
from foldmill.errors import UnreadableFile
from foldmill.exchange.graph import side_faces
from foldmill.exchange.linking import links
from foldmill.finding import Finding, Severity
from foldmill.pattern import Flags, Floats, Indices

_CUT = "BC"
_DASHES = 8
"""Lines that touch no other, from which on a person may have drawn dashes."""


@dataclass(frozen=True, eq=False)
class Outlined:
    """The lines of one sheet, and what was changed to get it."""

    points: Floats
    """(V, 2) mm."""
    edges: Indices
    """(E, 2) vertices."""
    letters: tuple[str, ...]
    angles: Floats
    """(E,) deg."""
    findings: tuple[Finding, ...]


def outlined(
    points: Floats, edges: Indices, letters: Sequence[str], angles: Floats, drop_loose: bool
) -> Outlined:
    """Return the sheet that the lines of a planar graph bound and crease.

    points : (V, 2) mm; edges : (E, 2); angles : (E,) deg; drop_loose : leave out lines that end
    inside the sheet. Raises UnreadableFile, saying where, for lines that make no single sheet.
    """
    loose = _loose(edges, len(points))
    if loose.all():
        raise _no_sheet(points, edges)
    ties = links(points, edges, letters, loose)
    if ties:
        edges = np.vstack([edges, ties]).astype(np.intp)
        letters = [*letters, *"F" * len(ties)]
        angles = np.append(angles, np.zeros(len(ties)))
        loose = _loose(edges, len(points))
    kept = ~loose
    found = [*_judge_loose(points, edges, kept, drop_loose)]
    used, flat = np.unique(edges[kept], return_inverse=True)
    spots, lines = points[used], flat.reshape(-1, 2)
    names = [letter for letter, stays in zip(letters, kept, strict=True) if stays]
    _refuse_apart(spots, lines)
    sides = _sides(spots, lines)
    names, said = _settled(names, sides, spots, lines)
    turns = np.where(np.isin(names, [*_CUT, "F"]), 0.0, angles[kept])
    return Outlined(spots, lines, tuple(names), turns, (*found, *_tied(len(ties)), *said))


def _tied(count: int) -> list[Finding]:
    if not count:
        return []
    message = f"{count} flat lines tie free cuts and holes to the lines about them; none is scored."
    return [Finding("import-tied", Severity.INFO, "", message)]


def _loose(edges: Indices, count: int) -> Flags:
    """Tell which edges (E,) hang on the rest by one end only, alone or as trees."""
    gone = np.zeros(len(edges), bool)
    around: list[list[int]] = [[] for _ in range(count)]
    for number, (a, b) in enumerate(edges.tolist()):
        around[a].append(number)
        around[b].append(number)
    degree = [len(each) for each in around]
    waiting = [vertex for vertex, many in enumerate(degree) if many == 1]
    while waiting:
        vertex = waiting.pop()
        for number in around[vertex]:
            if not gone[number]:
                gone[number] = True
                far = int(edges[number].sum()) - vertex
                degree[far] -= 1
                if degree[far] == 1:
                    waiting.append(far)
    return gone


def _judge_loose(points: Floats, edges: Indices, kept: Flags, drop: bool) -> list[Finding]:
    """Tell of loose lines outside the sheet, which mean nothing; refuse or drop those inside."""
    import shapely

    if kept.all():
        return []
    lines = points[edges[~kept]]
    rings = shapely.polygonize(shapely.linestrings(points[edges[kept]]).tolist())
    sheet = shapely.union_all(rings)
    shapely.prepare(sheet)
    middle = lines.mean(axis=1)
    inside = np.asarray(shapely.contains_xy(sheet, middle[:, 0], middle[:, 1]), bool)
    if inside.any() and not drop:
        lone = inside & ~np.isin(edges[~kept], edges[kept]).any(axis=1)
        raise _ends_inside(middle[inside], int(lone.sum()))
    kinds = (
        (~inside, "import-overshoot", "Lines beyond the outline were left out:"),
        (inside, "import-loose", "Lines that end inside the sheet were left out:"),
    )
    return [
        Finding(
            code,
            Severity.INFO if code == "import-overshoot" else Severity.WARNING,
            f"first near ({_xy(middle[which][0])}) mm",
            f"{words} {which.sum()}.",
            at=(float(middle[which][0][0]), float(middle[which][0][1])),
        )
        for which, code, words in kinds
        if which.any()
    ]


def _ends_inside(spots: Floats, lone: int) -> UnreadableFile:
    """Say where lines end inside the sheet, at spots (n, 2); lone : that touch none of the rest."""
    dashes = " If they are dashes, draw each dashed crease as one line." if lone >= _DASHES else ""
    return UnreadableFile(
        f"{_lines(len(spots))} inside the sheet without meeting another, first near "
        f"({_xy(spots[0])}) mm. Draw it on, let ends meet that are farther apart by --gap, or "
        f"leave such lines out by --loose drop.{dashes}"
    )


def _lines(count: int) -> str:
    return "A line ends" if count == 1 else f"{count} lines end"


def _no_sheet(points: Floats, edges: Indices) -> UnreadableFile:
    ends, count = np.unique(edges, return_counts=True)
    place = _xy(points[ends[count == 1][0]])
    return UnreadableFile(
        f"The lines enclose no sheet: the outline is open, or not drawn; a line ends at ({place}) "
        f"mm. Close it, or let ends meet that are farther apart by --gap."
    )


def _refuse_apart(points: Floats, edges: Indices) -> None:
    """Refuse lines in several groups that do not touch: other sheets, holes, ornaments."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    links = coo_array((np.ones(len(edges)), edges.T), shape=(len(points),) * 2)
    count, group = connected_components(links, directed=False)
    if count == 1:
        return
    largest = np.argmax([np.ptp(points[group == k], axis=0).prod() for k in range(count)])
    other = points[group != largest][0]
    raise UnreadableFile(
        f"The lines fall into {count} groups that do not touch each other; one is near "
        f"({_xy(other)}) mm. A sheet is one piece. Leave the others out (--as, skip), "
        f"or let ends meet by --gap."
    )


def _sides(points: Floats, edges: Indices) -> Indices:
    """Return for each edge (E,) on how many of its sides there is paper."""
    loops = planar.polygons(points, edges)
    if not loops:
        raise UnreadableFile("The lines enclose no sheet.")
    for loop in loops:
        if len(set(loop)) < len(loop):
            twice = next(v for k, v in enumerate(loop) if v in loop[:k])
            raise UnreadableFile(
                f"The lines about a facet meet themselves at ({_xy(points[twice])}) mm; a part "
                f"hangs on the rest there by one point only. Join it by another line, or leave it "
                f"out."
            )
    _refuse_pinched(points, loops)
    sides = {*side_faces(loops)}
    return np.array([((a, b) in sides) + ((b, a) in sides) for a, b in edges.tolist()])


def _refuse_pinched(points: Floats, loops: list[list[int]]) -> None:
    """Refuse facets that hang on the others by points or bare lines only: they would fall off."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    left = side_faces(loops)
    pairs = np.array([(f, left[b, a]) for (a, b), f in left.items() if (b, a) in left], np.intp)
    pairs = pairs.reshape(-1, 2)
    links = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(loops),) * 2)
    count, group = connected_components(links, directed=False)
    if count > 1:
        fewest = np.argmin(np.bincount(group))
        loop = loops[int(np.flatnonzero(group == fewest)[0])]
        raise UnreadableFile(
            f"The sheet falls into {count} parts that hang on each other by points or lines only; "
            f"one is near ({_xy(points[loop].mean(axis=0))}) mm. Join it by an edge, or drop it."
        )


def _settled(
    letters: Sequence[str], sides: Indices, points: Floats, edges: Indices
) -> tuple[list[str], list[Finding]]:
    """Return letters that fit the paper beside the lines, and what is to tell about it."""
    said: list[Finding] = []
    middle = points[edges].mean(axis=1)
    is_cut = np.isin(letters, [*_CUT])
    bare = (sides == 1) & ~is_cut
    if bare.any() and (is_cut & (sides == 1)).any():
        first = int(np.flatnonzero(bare)[0])
        raise UnreadableFile(
            f"There is no outline at ({_xy(middle[first])}) mm: the line there is {letters[first]} "
            f"and has paper on one side only. Draw the outline on, or say by --as what it is."
        )
    if bare.any():
        message = "No line is said to be the outline, so the outermost lines were taken for it."
        rim = "".join(sorted(set(np.array(letters)[sides == 1].tolist())))
        remedy = (
            f"They are drawn as {' and '.join(rim)}. If what they are drawn in means cutting, say "
            f"so by --as, as '#ff0000=C': inner lines drawn alike are scored otherwise."
            if set(rim) & {*"MV"}
            else ""
        )
        said.append(Finding("import-outline", Severity.WARNING, "", message, remedy))
    inner = int(np.count_nonzero((np.array(letters) == "B") & (sides == 2)))
    if inner:
        message = f"{inner} lines of the outline have paper on both sides: they are inner cuts."
        said.append(Finding("import-inner-cut", Severity.INFO, "", message))
    if not _has_creases(letters, sides):
        message = "No line of the drawing is a crease: none is mountain, valley or unassigned."
        remedy = "If some are, say which colour or layer they are by --as."
        if inner:
            remedy += (
                " As it is, all inner lines are cut through. Where they look like the outline, "
                "call them all U: the outermost are the outline then, and --unassigned front "
                "scores the others."
            )
        said.append(Finding("import-no-crease", Severity.WARNING, "", message, remedy))
    settled = [
        "B" if paper == 1 else "C" if letter in _CUT else letter
        for letter, paper in zip(letters, sides.tolist(), strict=True)
    ]
    return settled, said


def _has_creases(letters: Sequence[str], sides: Indices) -> bool:
    pairs = zip(letters, sides.tolist(), strict=True)
    return any(letter in "MVU" and paper == 2 for letter, paper in pairs)


def _xy(place: Floats) -> str:
    return f"{place[0]:.4g}, {place[1]:.4g}"
