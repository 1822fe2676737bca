"""Does the pattern say of each crease what the folded form does there?"""

from __future__ import annotations

import numpy as np

from foldmill.check.limits import limits
from foldmill.check.report import Figure, Report, counted, edge_name, not_checked
from foldmill.design import Fold
from foldmill.finding import Finding, Severity
from foldmill.folded import FoldedForm, fold_angles
from foldmill.pattern import Assignment, CreasePattern, Flags, Floats
from foldmill.tolerances import CLOSED_DEG
from foldmill.vectors import lengths

_TURN = 360.0


def assignment(fold: Fold) -> Report:
    """Count the assignments, and hold stated fold angles and seams against the folded form."""
    pattern = fold.pattern
    counts: dict[str, Figure] = {
        "mountains": pattern.count(Assignment.M),
        "valleys": pattern.count(Assignment.V),
        "flats": pattern.count(Assignment.F),
        "unassigned": pattern.count(Assignment.U),
    }
    open_edges = pattern.assignments == Assignment.U
    if fold.folded is None:
        missing = not_checked("fold angles and seams", "fold_angle_gap_deg", "seam_gap_mm")
        return Report.joined([Report(_unassigned(pattern, open_edges), counts), missing])
    measured = fold_angles(fold.folded.vertices, pattern.edges, pattern.faces, pattern.edge_faces)
    closed = open_edges & (np.abs(measured) >= 180.0 - CLOSED_DEG)
    findings = (*_unassigned(pattern, open_edges & ~closed), *_unsigned(pattern, closed))
    allowed = limits(fold)
    angles = _angles(pattern, measured, allowed.fold_angle_deg)
    return Report.joined([Report(findings, counts), angles, _seams(fold.folded, allowed.seam_mm)])


def _unassigned(pattern: CreasePattern, edges: Flags) -> tuple[Finding, ...]:
    where = np.flatnonzero(edges)
    if not len(where):
        return ()
    said = counted(len(where), "crease is", "creases are")
    finding = Finding(
        "unassigned",
        Severity.WARNING,
        edge_name(pattern, int(where[0])),
        f"{said} neither mountain, valley nor flat.",
        "Say which, or which face is to be scored when the sheet is planned.",
    )
    return (finding,)


def _unsigned(pattern: CreasePattern, edges: Flags) -> tuple[Finding, ...]:
    where = np.flatnonzero(edges)
    if not len(where):
        return ()
    said = counted(len(where), "crease closes", "creases close")
    finding = Finding(
        "closed-sign",
        Severity.WARNING,
        edge_name(pattern, int(where[0])),
        f"{said} to 180°, where the form cannot tell mountain from valley.",
        "The family must state the sign of such a crease.",
    )
    return (finding,)


def _angles(pattern: CreasePattern, measured: Floats, limit: float) -> Report:
    codes = pattern.assignments
    stated = (codes == Assignment.M) | (codes == Assignment.V) | (codes == Assignment.F)
    turn = measured - pattern.fold_angles
    # Near ±180 the sign is noise, so angles are compared round the circle.
    gaps = np.where(stated, np.abs((turn + _TURN / 2) % _TURN - _TURN / 2), 0.0)
    if not len(gaps):
        return Report((), {"fold_angle_gap_deg": 0.0})
    worst = int(gaps.argmax())
    figures: dict[str, Figure] = {
        "fold_angle_gap_deg": float(gaps[worst]),
        "fold_angle_limit_deg": limit,
    }
    wrong = int(np.count_nonzero(gaps > limit))
    if not wrong:
        return Report((), figures)
    finding = Finding(
        "fold-angle",
        Severity.ERROR,
        edge_name(pattern, worst),
        f"{counted(wrong, 'crease does', 'creases do')} not fold as stated: this one is stated as "
        f"{pattern.fold_angles[worst]:.4f}° and folds by {measured[worst]:.4f}°.",
        "The pattern and its folded form do not belong together.",
    )
    return Report((finding,), figures)


def _seams(folded: FoldedForm, limit: float) -> Report:
    if not len(folded.seams):
        return Report((), {"seams": 0, "seam_gap_mm": 0.0})
    ends = folded.vertices[folded.seams]
    gaps = lengths(ends[:, 1] - ends[:, 0])
    worst = int(gaps.argmax())
    figures: dict[str, Figure] = {
        "seams": len(gaps),
        "seam_gap_mm": float(gaps[worst]),
        "seam_limit_mm": limit,
    }
    if gaps[worst] <= limit:
        return Report((), figures)
    a, b = folded.seams[worst]
    finding = Finding(
        "seam",
        Severity.ERROR,
        f"vertices {a} and {b}",
        f"The seam stays open by {gaps[worst]:.3g} mm.",
        "The two vertices of a seam must meet in space.",
    )
    return Report((finding,), figures)
