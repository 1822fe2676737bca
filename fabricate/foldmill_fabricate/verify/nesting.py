"""Inner before outer: nothing is cut in a piece of sheet that was cut free before."""

from __future__ import annotations

from collections.abc import Sequence

from foldmill.finding import Finding, Severity
from foldmill_fabricate.verify.planned import Planned, at


def prove_nesting(strokes: Sequence[Planned]) -> list[Finding]:
    """Check that a cut inside a closed cut comes before it: afterwards what it is in is loose.

    strokes : of the whole job in order of work.
    """
    cuts = [stroke for stroke in strokes if stroke.setup.process == "cut"]
    found = []
    for late, early in _inside(cuts):
        found.append(
            Finding(
                "cut-in-loose-piece",
                Severity.ERROR,
                f"{cuts[late]} at {at(cuts[late].points[0])}",
                f"It lies inside {cuts[early]}, which is cut before it: that piece is loose then.",
                "Plan again.",
            )
        )
    return found


def _inside(cuts: Sequence[Planned]) -> list[tuple[int, int]]:
    """Return pairs (later, earlier) of which the later one lies inside the earlier, closed one."""
    import shapely

    rims = [k for k, stroke in enumerate(cuts) if stroke.closed]
    if not rims:
        return []
    areas = [shapely.Polygon(cuts[k].points) for k in rims]
    lines = [shapely.LineString(stroke.points) for stroke in cuts]
    inner, outer = shapely.STRtree(areas).query(lines, predicate="within")
    pairs = zip(inner.tolist(), (rims[k] for k in outer.tolist()), strict=True)
    return sorted((late, early) for late, early in pairs if late > early)
