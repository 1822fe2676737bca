"""How the flip keeps register: holes, pins, optical marks or edges, and a mark that shows the turn.

Of holes, two pairs are symmetric about the flip axis, so that a turned sheet shows holes where
holes were. Their spacings differ and they are not symmetric about the other centre line, so that a
sheet turned the wrong way shows it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.kinds import RegistrationKind
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Holes, Material
from foldmill_fabricate.passes import (
    Flip,
    Hole,
    Mark,
    Register,
    Sheet,
    Stroke,
)
from foldmill_fabricate.plan import optical, pins
from foldmill_fabricate.plan.stops import stops
from foldmill_fabricate.sheet import flipped
from foldmill_fabricate.toolpath.knife import facets, is_facetted

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

GRID = 1.0
"""mm between the places tried."""
DIFFERENCE = 20.0
"""mm by which the two pairs differ, so that a wrong turn is plain to the eye."""
WITNESS = np.array([[[0, 0], [0, 12]], [[0, 12], [8, 12]], [[0, 7], [6, 7]]], float)
"""(3, 2, 2) the strokes of a letter F, mm: it is not its own mirror image."""
WITNESS_CLEARANCE = 3.0
"""mm around the witness mark to the part, the edge and the holes."""


UNHELD = Register(kind="none")


@dataclass(frozen=True)
class Registration:
    """Holes and witness mark, in sheet coordinates; empty where nothing fits, with the reason."""

    holes: tuple[Hole, ...] = ()
    witness: tuple[Stroke, ...] = ()
    findings: tuple[Finding, ...] = ()
    made: Register = UNHELD
    """What the plan says of it."""


def register(
    kind: RegistrationKind,
    rims: Sequence[Floats],
    sheet: Sheet,
    flip: Flip,
    material: Material,
    machine: Machine,
) -> Registration:
    """Find what keeps the faces in register in the waste around parts, outlines (n, 2), mm.

    Where it does not fit, edge stops take its place and a finding says by how much. Raises
    CannotPlan for a kind that the machine does not offer.
    """
    _refuse(kind, machine)
    if kind == "none":
        return Registration(findings=(_unheld(),))
    part = parts(rims)
    found = _found(kind, part, sheet, flip, material, machine)
    if found.made.kind == "edge":
        found = replace(found, made=Register(kind="edge", stops=stops(sheet, flip)))
    witness, more = _witness(_with(part, found.made.marks), sheet, found.holes)
    return replace(found, witness=witness, findings=(*found.findings, *more))


def offered(machine: Machine) -> list[str]:
    """Return the kinds of registration that a machine, or its operator, can do."""
    names = [each.removesuffix("-3").removesuffix("-4") for each in machine.marks.kinds]
    return [*dict.fromkeys(name for name in names if name != "two-target"), "none"]


def _refuse(kind: RegistrationKind, machine: Machine) -> None:
    if kind not in offered(machine):
        raise CannotPlan(
            f"{machine.slug} cannot register a flipped sheet by {kind}; it can by "
            f"{', '.join(offered(machine))}."
        )


def _found(
    kind: RegistrationKind,
    part: Any,
    sheet: Sheet,
    flip: Flip,
    material: Material,
    machine: Machine,
) -> Registration:
    """Return what fits, without the witness mark; kind edge where nothing does."""
    edge = Register(kind="edge")
    if kind == "edge":
        return Registration(made=edge)
    if not material.cut.goes_through:
        return Registration(findings=(_not_cut(material),), made=edge)
    if kind == "l-marks":
        marks, findings = optical.find(part, sheet, flip, material, machine.marks)
        made = Register(kind="l-marks", marks=marks) if marks else edge
        return Registration(findings=findings, made=made)
    if kind == "pins":
        holes, findings = pins.find(part, sheet, flip, material.holes, machine.marks)
        spots = pins.on_machine(holes, sheet, flip) if holes else ()
        made = Register(kind="pins", pins=spots) if holes else edge
        return Registration(holes, findings=findings, made=made)
    found = _holes(part, sheet, flip, material.holes)
    if not found:
        return Registration(findings=(_no_room(part, sheet, material.holes),), made=edge)
    return Registration(found, made=Register(kind="holes"))


def _holes(part: Any, sheet: Sheet, flip: Flip, holes: Holes) -> tuple[Hole, ...]:
    radius = holes.diameter / 2
    room = (holes.edge_clearance + radius, holes.part_clearance + radius)
    spots = _grid(sheet)
    spots = spots[_is_free(spots, part, sheet, *room)]
    spots = spots[_is_free(flipped(spots, flip), part, sheet, *room)]
    return tuple(
        Hole(x=float(x), y=float(y), diameter=holes.diameter)
        for spot in _two_pairs(spots, sheet, flip) or ()
        for x, y in np.vstack([spot, flipped([spot], flip)])
    )


def _with(part: Any, marks: tuple[Mark, ...]) -> Any:
    """Return the area that parts and optical marks take."""
    import shapely

    return shapely.union_all([part, *map(optical.box, marks)]) if marks else part


def _unheld() -> Finding:
    return Finding(
        "no-registration",
        Severity.WARNING,
        "waste",
        "Nothing keeps the reverse in register with the front, as was asked for.",
        "Plan without --registration none where the faces must match.",
    )


def parts(rims: Sequence[Floats]) -> Any:
    """Return the area of all parts, their outlines (n, 2) on the sheet."""
    import shapely

    shapes = [shapely.Polygon(rim) for rim in rims]
    return shapes[0] if len(shapes) == 1 else shapely.union_all(shapes)


def _grid(sheet: Sheet) -> Floats:
    x = np.arange(GRID / 2, sheet.width, GRID)
    y = np.arange(GRID / 2, sheet.height, GRID)
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def _is_free(spots: Floats, part: Any, sheet: Sheet, edge: float, clearance: float) -> Flags:
    """Tell which spots (n, 2) are that far from the blank's edge and from the parts."""
    import shapely

    size = np.array([sheet.width, sheet.height])
    inside = np.asarray(((spots >= edge) & (spots <= size - edge)).all(axis=1), bool)
    taken = part.buffer(clearance)
    shapely.prepare(taken)
    outside: Flags = ~shapely.contains_xy(taken, *spots.T)
    return inside & outside


def _two_pairs(spots: Floats, sheet: Sheet, flip: Flip) -> tuple[Floats, Floats] | None:
    """Return one hole of each pair: far apart, and different enough.

    spots : (n, 2) mm, free here and, turned over, free there.
    """
    k = 0 if flip.kind == "left-right" else 1
    middle = (sheet.height if k == 0 else sheet.width) / 2
    both = spots
    reach, along = both[:, k] - flip.axis, both[:, 1 - k] - middle
    both, reach, along = both[reach > 0], reach[reach > 0], along[reach > 0]
    best: tuple[float, int, int] | None = None
    for sign in (1.0, -1.0):
        first = np.where(sign * along > 0, reach + sign * along, -np.inf)
        if not np.isfinite(first).any():
            continue
        i = int(np.argmax(first))
        differs = (np.abs(reach - reach[i]) >= DIFFERENCE) & (
            np.abs(along + along[i]) >= DIFFERENCE
        )
        second = np.where((sign * along < 0) & differs, reach - sign * along, -np.inf)
        j = int(np.argmax(second))
        if np.isfinite(second[j]) and (best is None or first[i] + second[j] > best[0] + 1e-9):
            best = (float(first[i] + second[j]), i, j)
    return None if best is None else (both[best[1]], both[best[2]])


def _not_cut(material: Material) -> Finding:
    return Finding(
        "no-registration-holes",
        Severity.WARNING,
        "waste",
        f"Holes and marks are cut through, and this outline is made by {material.cut.title}.",
        "Lay both passes against the same edge stops, as the job sheet says.",
    )


def _no_room(part: Any, sheet: Sheet, holes: Holes) -> Finding:
    import shapely

    blank = shapely.box(0, 0, sheet.width, sheet.height)
    free = blank.difference(part)
    widest = shapely.maximum_inscribed_circle(free).length if not free.is_empty else 0.0
    need = holes.diameter / 2 + max(holes.part_clearance, holes.edge_clearance)
    short = f"{need - widest:.1f} mm short" if widest < need else "not in two different pairs"
    return Finding(
        "no-registration-holes",
        Severity.WARNING,
        "waste",
        f"Four registration holes do not fit beside the part: the widest free circle has a radius "
        f"of {widest:.1f} mm and a hole needs {need:.1f} mm ({short}).",
        "Lay both passes against the same edge stops of the job sheet, or take a larger blank.",
    )


def _witness(
    part: Any, sheet: Sheet, holes: tuple[Hole, ...]
) -> tuple[tuple[Stroke, ...], tuple[Finding, ...]]:
    """Place the F near the upper left corner, where it is clear of everything."""
    size = WITNESS.reshape(-1, 2).max(axis=0)
    reach = float(np.hypot(*size)) / 2 + WITNESS_CLEARANCE
    middles = _grid(sheet)
    middles = middles[_is_free(middles, part, sheet, reach, reach)]
    for hole in holes:
        apart = np.hypot(*(middles - np.array([hole.x, hole.y])).T)
        middles = middles[apart >= reach + hole.diameter / 2]
    if not len(middles):
        return (), (
            Finding(
                "no-witness-mark",
                Severity.WARNING,
                "waste",
                "There is no room in the waste for the mark that shows the sheet was flipped.",
                "Write an F on the front by hand before the first pass.",
            ),
        )
    spot = middles[int(np.argmin(middles[:, 0] - middles[:, 1]))] - size / 2
    return tuple(
        Stroke(points=tuple((float(x), float(y)) for x, y in line + spot)) for line in WITNESS
    ), ()


def hole_rim(hole: Hole, offset: float) -> Stroke:
    """Return a hole's rim as a blade of this offset (mm) can follow it."""
    return facetted(hole, offset) if is_facetted(hole.diameter / 2, offset) else circle(hole)


def circle(hole: Hole, corner_tolerance: float = 0.02) -> Stroke:
    """Return a hole's rim as a closed polygon that leaves the circle by no more than that, mm."""
    radius = hole.diameter / 2
    corners = max(12, int(np.ceil(np.pi / np.arccos(1 - corner_tolerance / radius))))
    return _polygon(hole, radius, corners)


def facetted(hole: Hole, offset: float) -> Stroke:
    """Return a closed polygon round a hole that a blade of this offset can follow, mm.

    Its sides touch the hole's circle from outside, so that a pin of the hole's diameter fits.
    """
    count = facets(hole.diameter / 2, offset)
    return _polygon(hole, hole.diameter / 2 / float(np.cos(np.pi / count)), count)


def _polygon(hole: Hole, radius: float, corners: int) -> Stroke:
    angles = 2 * np.pi * np.arange(corners) / corners
    rim = [(float(hole.x + radius * np.cos(a)), float(hole.y + radius * np.sin(a))) for a in angles]
    return Stroke(points=(*rim, rim[0]))
