"""What is wrong with a job, on the sheet: lines missing, extra and moved, face by face."""

from __future__ import annotations

import re
from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Face, Pass, Plan
from foldmill_fabricate.pictures import canvas, sheet
from foldmill_fabricate.verify.faults import Fault, Kind
from foldmill_fabricate.verify.report import ranked
from foldmill_fabricate.verify.verification import Verification

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LOOKS: dict[Kind, tuple[str, float]] = {
    Kind.MISSING: ("#d01010", 2.4),
    Kind.EXTRA: ("#f07800", 2.4),
    Kind.MOVED: ("#7000b0", 1.8),
}
"""Colour and width in points."""
AS_PLANNED = ("#b0b8c0", 0.7)
ARROW = 0.07
"""Length of an arrow as a share of the sheet: the shift itself is too short to be seen."""
MOST_ARROWS = 40
"""More only hide each other."""
MARK = "#d01010"
TOLD = 6
"""Findings that are written out below."""
WIDTH = 150
"""Letters in a line of words, for two faces."""
_TOLD_IN_MESSAGE = {"extra-line", "dip", "swivel-missing"}
"""Findings whose place in the program is not their place on the sheet."""
_PLACE = re.compile(r"\((-?\d+\.\d+), (-?\d+\.\d+)\) mm")


def faults_picture(plan: Plan, found: Verification) -> bytes:
    """Return a PNG of each face that is worked, seen from the front, with what is wrong on it."""
    works = plan.passes
    with canvas.own_style():
        figure = canvas.figure(max(1, len(works)) * 160, 205)
        numbered = list(enumerate((f for kind in ranked(found.findings) for f in kind), start=1))
        for k, work in enumerate(works):
            box = ((k + 0.03) / len(works), 0.19, 0.94 / len(works), 0.7)
            faults = [fault for fault in found.faults if fault.face is work.face]
            axes = canvas.flat_axes(figure, box)
            _draw(axes, plan, work, faults)
            _mark(axes, [each for each in numbered if _face(each[1], plan) in {None, work.face}])
        words = _words(numbered, WIDTH * max(1, len(works)) // 2)
        figure.text(0.03, 0.11, words, fontsize=7.5, va="top")
        errors = sum(finding.severity == "error" for finding in found.findings)
        counted = f"{errors} {'error' if errors == 1 else 'errors'}"
        verdict = f"NOT to be cut: {counted}" if errors else "nothing is wrong"
        title = plan.title or "Job"
        figure.suptitle(f"{title}, {verdict}. Both faces seen from the front", fontsize=11)
        return canvas.png(figure)


def _draw(axes: Axes, plan: Plan, work: Pass, faults: Sequence[Fault]) -> None:
    width, height = plan.sheet.width, plan.sheet.height
    span = max(width, height)
    xs, ys = [0, width, width, 0], [0, 0, height, height]
    axes.fill(xs, ys, facecolor="#fafafa", edgecolor="#606060")
    colour, line = AS_PLANNED
    canvas.add_lines(axes, _planned(work), color=colour, linewidth=line)
    canvas.legend_entry(axes, "as planned", color=colour, linewidth=line)
    sheet.draw_lead_ins(axes, sheet.lead_ins(plan, work.face))
    for kind, (colour, line) in LOOKS.items():
        lines = [fault.points for fault in faults if fault.kind is kind]
        if lines:
            canvas.add_lines(axes, lines, color=colour, linewidth=line)
            canvas.legend_entry(axes, f"{kind}: {len(lines)}", color=colour, linewidth=line)
    moved = [fault for fault in faults if fault.kind is Kind.MOVED]
    for fault in moved[:MOST_ARROWS]:
        _arrow(axes, fault, ARROW * span)
    axes.set_title(work.face.value.upper(), fontsize=10)
    canvas.scale_bar(axes, 0, -0.035 * span, span)
    axes.set_xlim(-0.03 * span, width + 0.03 * span)
    axes.set_ylim(-0.06 * span, height + 0.03 * span)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=4, frameon=False, fontsize=9)


def place(finding: Finding) -> tuple[float, float] | None:
    """Return where on the sheet a finding is, mm: as it says itself, or as its place is written."""
    told = finding.where + finding.message * (finding.code in _TOLD_IN_MESSAGE)
    written = _PLACE.search(told)
    if finding.at is None and written is not None:
        return float(written[1]), float(written[2])
    return finding.at


def _face(finding: Finding, plan: Plan) -> Face | None:
    """Return the face a finding speaks of, or None where it may be either."""
    for file in plan.programs:
        if finding.where.startswith(file.name):
            return file.face
    return next((face for face in Face if f"on the {face}" in str(finding)), None)


def _mark(axes: Axes, numbered: Sequence[tuple[int, Finding]]) -> None:
    """Ring the places of errors, with their numbers in the report."""
    for number, finding in numbered:
        at = place(finding)
        if at is None or finding.severity is not Severity.ERROR:
            continue
        axes.plot(*at, marker="o", markersize=14, color=MARK, fillstyle="none", linewidth=0)
        look = {"textcoords": "offset points", "fontsize": 8, "color": MARK}
        axes.annotate(str(number), xy=at, xytext=(8, 8), **look)  # type: ignore[arg-type]


def _words(numbered: Sequence[tuple[int, Finding]], width: int) -> str:
    """Write out the first findings; the report tells of all."""
    told = [fill(f"{number}. {finding}", width) for number, finding in numbered[:TOLD]]
    more = len(numbered) - len(told)
    return "\n".join([*told, f"and {more} more: see the report"] if more > 0 else told)


def _planned(work: Pass) -> list[np.ndarray]:
    return [
        np.asarray(stroke.points, float)
        for setup in work.setups
        for operation in setup.operations
        for stroke in operation.strokes
    ]


def _arrow(axes: Axes, fault: Fault, length: float) -> None:
    """Point at a moved line from where it came, and write by how much."""
    shift = np.array(fault.shift)
    size = float(np.hypot(*shift))
    away = shift / size if size else np.array([0.0, 1.0])
    middle = (fault.points.max(axis=0) + fault.points.min(axis=0)) / 2
    colour, _ = LOOKS[Kind.MOVED]
    axes.annotate(
        f"{size:.2f} mm",
        xy=tuple(middle),
        xytext=tuple(middle - length * away),
        arrowprops={"arrowstyle": "->", "color": colour},
        color=colour,
        fontsize=8,
        ha="center",
        va="center",
    )
