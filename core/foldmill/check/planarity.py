"""Is the pattern a planar straight-line graph with one outline, and do its faces fill that outline?

Edges meet only in vertices; every vertex is one point; the boundary is one simple polygon. Together
with faces that run counter-clockwise this leaves no paper upon paper.

A slit has no width: its banks lie upon each other. The pattern is looked at with its slits sewn up,
so that they are inner cuts and the outline goes past their mouths.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from foldmill import planar, sweep
from foldmill.check.report import Figure, Report, counted, edge_name, vertex_name
from foldmill.design import Fold
from foldmill.finding import Finding, Severity
from foldmill.pattern import Assignment, CreasePattern, Flags, Floats, Indices
from foldmill.slits import Sewn, sewn
from foldmill.tolerances import COINCIDENT_MM
from foldmill.vectors import lengths, units


def planarity(fold: Fold) -> Report:
    """Look for vertices upon vertices and edges, edges across edges, and a broken outline."""
    pattern = fold.pattern
    size = np.ptp(pattern.vertices, axis=0) if len(pattern.vertices) else np.zeros(2)
    figures: dict[str, Figure] = {
        "vertices": len(pattern.vertices),
        "edges": len(pattern.edges),
        "faces": len(pattern.faces),
        "width_mm": float(size[0]),
        "height_mm": float(size[1]),
    }
    closed = sewn(pattern)
    figures["slits"] = len(pattern.edges) - len(closed.edges)
    return Report.joined([Report((), figures), _graph(pattern, closed), _outline(pattern, closed)])


@dataclass(frozen=True, eq=False)
class Faults:
    """What keeps lines from being a planar straight-line graph."""

    coincident: Indices
    """(k, 2) pairs of vertices that are one point."""
    lying: Indices
    """(k, 2) a vertex, and an edge that runs through it."""
    crossing: Indices
    """(k, 2) pairs of edges that cross between their ends."""

    def beside(self, closed: Sewn) -> Faults:
        """Return what is wrong beside the slits, by the numbers of the opened pattern."""
        known = set(map(tuple, closed.pairs.tolist()))
        kept = [pair for pair in self.coincident.tolist() if tuple(pair) not in known]
        lying = self.lying.copy()
        lying[:, 1] = closed.edges[lying[:, 1]]
        coincident = np.array(kept, np.intp).reshape(-1, 2)
        return Faults(coincident, lying, closed.edges[self.crossing])


def faults(points: Floats, edges: Indices) -> Faults:
    """Find what keeps points (V, 2) and edges (E, 2) from being a planar straight-line graph."""
    ends = points[edges]
    low, high = ends.min(axis=1) - COINCIDENT_MM, ends.max(axis=1) + COINCIDENT_MM
    pairs = sweep.meeting(points - COINCIDENT_MM, points + COINCIDENT_MM)
    crossing = sweep.meeting(low, high)
    lying = sweep.within(points, low, high)
    lying = lying[(edges[lying[:, 1]] != lying[:, :1]).all(axis=1)]
    one, two = edges[crossing[:, 0]], edges[crossing[:, 1]]
    crossing = crossing[(one != two).all(axis=1) & (one != two[:, ::-1]).all(axis=1)]
    return Faults(
        _sorted(pairs[lengths(points[pairs[:, 0]] - points[pairs[:, 1]]) <= COINCIDENT_MM]),
        _sorted(lying[_is_inside(points, edges, lying)]),
        _sorted(crossing[_is_crossing(points, edges, crossing)]),
    )


def _sorted(pairs: Indices) -> Indices:
    ordered: Indices = pairs[np.lexsort(pairs.T[::-1])]
    return ordered


def _is_inside(points: Floats, edges: Indices, pairs: Indices) -> Flags:
    """Tell which vertices lie on an edge, and at neither of its ends."""
    spots, ends = points[pairs[:, 0]], points[edges[pairs[:, 1]]]
    apart = (lengths(ends - spots[:, None]) > COINCIDENT_MM).all(axis=1)
    start, step = ends[:, 0], ends[:, 1] - ends[:, 0]
    squared = (step * step).sum(axis=1)
    share = ((spots - start) * step).sum(axis=1) / np.where(squared > 0, squared, 1.0)
    foot = start + np.clip(share, 0.0, 1.0)[:, None] * step
    inside: Flags = apart & (lengths(spots - foot) <= COINCIDENT_MM)
    return inside


def _is_crossing(points: Floats, edges: Indices, pairs: Indices) -> Flags:
    """Tell which edges have their ends on both sides of each other."""
    lines, others = points[edges[pairs[:, 0]]], points[edges[pairs[:, 1]]]
    crossing: Flags = _straddles(lines, others) & _straddles(others, lines)
    return crossing


def _straddles(line: Floats, other: Floats) -> Flags:
    """Tell whether the ends of ``other`` (n, 2, 2) lie on both sides of ``line`` (n, 2, 2)."""
    along = units(line[:, 1] - line[:, 0])
    step = other - line[:, :1]
    height = along[:, None, 0] * step[:, :, 1] - along[:, None, 1] * step[:, :, 0]
    one, two = height[:, 0], height[:, 1]
    both: Flags = np.minimum(one, two) < -COINCIDENT_MM
    both &= np.maximum(one, two) > COINCIDENT_MM
    return both


def _graph(pattern: CreasePattern, closed: Sewn) -> Report:
    found = faults(pattern.vertices, closed.pattern.edges).beside(closed)
    figures: dict[str, Figure] = {
        "coincident_vertices": len(found.coincident),
        "vertices_on_edges": len(found.lying),
        "crossings": len(found.crossing),
    }
    findings = []
    for a, b in found.coincident[:1]:
        said = counted(len(found.coincident), "pair of vertices is", "pairs of vertices are")
        where = f"{vertex_name(pattern, a)} and vertex {b}"
        findings.append(_fault("coincident-vertices", where, f"{said} one point.", "Merge them."))
    for vertex, edge in found.lying[:1]:
        said = counted(len(found.lying), "vertex lies", "vertices lie")
        where = f"{vertex_name(pattern, vertex)} on {edge_name(pattern, edge)}"
        remedy = "Divide the edge at the vertex."
        findings.append(_fault("vertex-on-edge", where, f"{said} inside an edge.", remedy))
    for a, b in found.crossing[:1]:
        said = counted(len(found.crossing), "pair of edges crosses", "pairs of edges cross")
        where = f"{edge_name(pattern, a)} and {edge_name(pattern, b)}"
        remedy = "Put a vertex where they cross."
        findings.append(_fault("edges-cross", where, f"{said} between their ends.", remedy))
    return Report(tuple(findings), figures)


def _outline(pattern: CreasePattern, closed: Sewn) -> Report:
    loops, border = pattern.outline(), pattern.count(Assignment.B)
    figures: dict[str, Figure] = {"outline_loops": len(loops)}
    stray = border - sum(len(loop) for loop in loops)
    if len(loops) != 1 or stray:
        said = f"The boundary has {counted(len(loops), 'closed loop', 'closed loops')}"
        said += f" and {counted(stray, 'edge', 'edges')} beside." if stray else ", not one."
        remedy = "A sheet has one outline; draw cuts inside it as cuts."
        return Report((_fault("outline", "outline", said, remedy),), figures)
    reason = _broken(closed.pattern)
    if reason:
        remedy = "Move its vertices apart."
        return Report((_fault("outline", "outline", reason, remedy),), figures)
    return Report.joined([Report((), figures), _filling(pattern, pattern.vertices[loops[0]])])


def _broken(closed: CreasePattern) -> str:
    """Return what is wrong with the one outline of a pattern whose slits are sewn up."""
    import shapely

    loops = closed.outline()
    if len(loops) != 1:
        return f"Slits divide the sheet: sewn up, it has {len(loops)} closed loops."
    outline = shapely.Polygon(closed.vertices[loops[0]])
    if outline.is_valid:
        return ""
    return f"The outline meets itself ({shapely.is_valid_reason(outline)})."


def _filling(pattern: CreasePattern, loop: Floats) -> Report:
    area = planar.signed_area(loop)
    corners = pattern.vertices[pattern.faces]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    gap = area - float((one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]).sum()) / 2
    figures: dict[str, Figure] = {"area_mm2": area, "area_gap_mm2": abs(gap)}
    rim = float(lengths(loop - np.roll(loop, -1, axis=0)).sum())
    if abs(gap) <= COINCIDENT_MM * rim:
        return Report((), figures)
    said = "leave open" if gap > 0 else "overlap by"
    message = f"The faces {said} {abs(gap):.6g} of the {area:.6g} mm² inside the outline."
    remedy = "Faces must fill the sheet once."
    return Report((_fault("faces", "faces", message, remedy),), figures)


def _fault(code: str, where: str, message: str, remedy: str) -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)
