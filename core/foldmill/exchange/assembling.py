"""From the lines of a drawing to a fold: scaled, named, joined, one sheet.

Whatever was changed or had to be supposed is told by ``Fold.findings``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from foldmill.design import Fold
from foldmill.errors import UnreadableFile
from foldmill.exchange.drawing import Drawing
from foldmill.exchange.limits import DEFAULT, Limits
from foldmill.exchange.mending import RANKS, findings_of
from foldmill.exchange.naming import named
from foldmill.exchange.options import Options
from foldmill.exchange.outlining import Outlined, outlined
from foldmill.exchange.scaling import factor
from foldmill.finding import Finding, Severity
from foldmill.pattern import CreasePattern, Floats
from foldmill.planarise import Change, planarise
from foldmill.planarise.lines import TOUCH_MM
from foldmill.tolerances import FLAT_DEG, FOLD_ANGLE_READ_DEG

GAP_SHARES = (1e-4, 2.5e-4, 5e-4, 1e-3)
"""Shares of the sheet's size within which ends of lines meet, the first that gives a sheet: 0.04 mm
of 400. Files of three decimals miss by less; drawings by hand miss by up to 0.4, and nobody folds
anything so small."""
_CLOSED = 180.0


@dataclass(frozen=True, eq=False)
class _Lines:
    """What is made of the drawing: mm, with the lower left corner at 0."""

    segments: Floats
    letters: list[str]
    angles: list[float]


def fold_of(drawing: Drawing, options: Options, limits: Limits = DEFAULT) -> Fold:
    """Return the crease pattern of a drawing; raises UnreadableFile, saying where and what to do.

    Raises InvalidPattern where its lines cross so often that they would become too many.

    The sheet lies as the drawing shows it, the lower left corner of its outline at (0, 0), whatever
    reaches beyond.
    """
    meant = named(drawing.looks, options)
    lines = _lines_of(drawing, meant.letters, options)
    size = float(np.ptp(lines.segments.reshape(-1, 2), axis=0).max())
    if size <= TOUCH_MM:
        raise UnreadableFile(f"The whole drawing is {size:g} mm wide; say how wide by --width.")
    sheet, said = _joined(lines, size, options, limits.lines)
    pattern = CreasePattern.from_lines(sheet.points, sheet.edges, sheet.letters, sheet.angles)
    title = {"title": drawing.title} if drawing.title else {}
    findings = (*meant.findings, *_notes(drawing.notes), *said, *sheet.findings)
    return Fold(pattern, meta={"read": True, **title}, findings=findings)


def _lines_of(drawing: Drawing, said: Sequence[str], options: Options) -> _Lines:
    kept = [k for k, letter in enumerate(said) if letter]
    letters, angles = _folded([said[k] for k in kept], drawing, kept)
    lines = drawing.upright()[kept]
    lines = lines * factor(lines, letters, drawing.millimetres, options)
    outline = np.isin(letters, ["B", "C"])
    framed = lines[outline] if outline.any() else lines
    return _Lines(lines - framed.reshape(-1, 2).min(axis=0), letters, angles)


def _joined(
    lines: _Lines, size: float, options: Options, most: int
) -> tuple[Outlined, list[Finding]]:
    """Return the sheet, its lines joined within the least gap that gives one."""
    gaps = [options.gap] if options.gap else [max(TOUCH_MM, size * each) for each in GAP_SHARES]
    first: UnreadableFile | None = None
    for gap in gaps:
        try:
            sheet, said = _sheet(lines, gap, options, most)
        except UnreadableFile as error:
            first = first or error
        else:
            return sheet, [*said, *([] if gap == gaps[0] else [_joined_far(gap)])]
    raise first or UnreadableFile("The lines enclose no sheet.")


def _joined_far(gap: float) -> Finding:
    message = f"The lines make a sheet only where ends meet that are up to {gap:.3g} mm apart."
    remedy = "Look at the picture of `foldmill show`; --gap says another measure."
    return Finding("import-gap", Severity.WARNING, "", message, remedy)


def _sheet(
    lines: _Lines, gap: float, options: Options, most: int
) -> tuple[Outlined, list[Finding]]:
    kinds = list(zip(lines.letters, lines.angles, strict=True))
    numbers = {kind: k for k, kind in enumerate(dict.fromkeys(kinds))}
    ranks = [RANKS[letter] for letter in lines.letters]
    found = planarise(lines.segments, [numbers[kind] for kind in kinds], ranks, gap, most)
    _refuse_conflicts(found.changes, lines)
    sheet = outlined(
        found.points,
        found.edges,
        [lines.letters[k] for k in found.lines.tolist()],
        np.array(lines.angles)[found.lines],
        options.loose == "drop",
    )
    return sheet, [*findings_of(found.changes)]


def _folded(
    letters: Sequence[str], drawing: Drawing, kept: Sequence[int]
) -> tuple[list[str], list[float]]:
    """Return letters and fold angles; a mountain or valley of opacity 0 folds by nothing."""
    found: list[str] = []
    angles: list[float] = []
    for letter, line in zip(letters, kept, strict=True):
        turn = {"M": -_CLOSED, "V": _CLOSED}.get(letter, 0.0) * drawing.looks[line].opacity
        is_flat = letter in "MV" and abs(turn) <= FLAT_DEG
        found.append("F" if is_flat else letter)
        angles.append(0.0 if is_flat else turn)
    return found, angles


def _refuse_conflicts(changes: Sequence[Change], lines: _Lines) -> None:
    letters, angles = lines.letters, lines.angles
    for change in changes:
        one, two = change.line, change.under
        if change.what != "overlap" or not {letters[one], letters[two]} <= {*"MV"}:
            continue
        if abs(angles[one] - angles[two]) > FOLD_ANGLE_READ_DEG:
            said = " and ".join(f"{letters[n]}, {angles[n]:g}°" for n in sorted((one, two)))
            place = f"at ({change.x:.4g}, {change.y:.4g}) mm"
            apart = _apart(np.array([change.x, change.y]), *lines.segments[[one, two]])
            if apart <= TOUCH_MM:
                raise UnreadableFile(
                    f"Two creases lie upon each other {place} and fold differently: {said}. "
                    f"Remove one of them."
                )
            raise UnreadableFile(
                f"Two creases run side by side {place}, {apart:.2g} mm apart, and fold "
                f"differently: {said}. No sheet folds in so narrow a strip: move or remove one of "
                f"them. If they are meant so, a smaller --gap keeps them apart."
            )


def _apart(place: Floats, one: Floats, two: Floats) -> float:
    """Return how far two lines (2, 2) are apart at a place, mm."""
    spot = _nearest(place, one)
    return float(np.hypot(*(spot - _nearest(spot, two))))


def _nearest(place: Floats, line: Floats) -> Floats:
    along = line[1] - line[0]
    share = np.clip((place - line[0]) @ along / (along @ along), 0.0, 1.0)
    nearest: Floats = line[0] + share * along
    return nearest


def _notes(notes: Sequence[str]) -> list[Finding]:
    return [Finding("import-note", Severity.INFO, "", note) for note in notes]
