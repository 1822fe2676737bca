"""Every crease is scored once, on the face that the process asks for, and nothing else is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment
from foldmill.finding import Finding, Severity
from foldmill.tolerances import COINCIDENT_MM
from foldmill_fabricate.materials import Perforation
from foldmill_fabricate.passes import Face, Role
from foldmill_fabricate.verify import rows, tolerances
from foldmill_fabricate.verify.asked import FACES, NOWHERE, Asked
from foldmill_fabricate.verify.cover import (
    Pairs,
    Pieces,
    Stretches,
    difference,
    pairs,
    pieces,
    stretches,
    uncovered,
)
from foldmill_fabricate.verify.planned import Planned, at
from foldmill_fabricate.verify.rows import prove_rows

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


def prove_creases(asked: Asked, strokes: Sequence[Planned]) -> list[Finding]:
    """Compare the score strokes of both faces with the creases of the pattern."""
    unassigned = _unassigned(asked)
    scores = [[s for s in strokes if s.role is Role.SCORE and s.face is face] for face in FACES]
    drawn = [pieces([stroke.points for stroke in face]) for face in scores]
    wrong = _on_wrong_face(asked, drawn)
    whole = float(asked.lengths[asked.score_face != NOWHERE].sum())
    score = asked.plan.material.score
    if whole and float(asked.lengths[wrong].sum()) >= tolerances.EXPLAINED * whole:
        return [*unassigned, _swapped(asked)]
    found = [_wrong_face(asked, edge) for edge in np.flatnonzero(wrong).tolist()]
    for face in (0, 1):
        if not isinstance(score, Perforation):
            found += _missing(asked, face, drawn[face], wrong)
        found += _too_much(asked, face, drawn[face], wrong)
        found += _stray(asked, face, drawn[face], scores[face], wrong)
    if isinstance(score, Perforation):
        found += prove_rows(asked, score, drawn[1], scores[1])
    return unassigned + found


def astray(asked: Asked, strokes: Sequence[Planned]) -> list[tuple[Face, bool, Pieces, Stretches]]:
    """Return stretches that are not scored (True), and that are and should not be (False)."""
    found = []
    least, most = asked.setbacks
    for face, name in enumerate(FACES):
        drawn = pieces([s.points for s in strokes if s.role is Role.SCORE and s.face is name])
        mine = asked.score_face == face
        near, along = _coverage(asked, mine, drawn)
        required = _between(mine, most[:, 0], asked.lengths - most[:, 1])
        allowed = _between(mine, least[:, 0], asked.lengths - least[:, 1])
        lost, more = difference(along, required), difference(along, allowed)
        if isinstance(asked.plan.material.score, Perforation):
            lost = stretches(())  # a row has gaps; what is wrong with one is told in words
        found += [
            (name, True, asked.lines(mine), _marked(lost.take(lost.count < 0))),
            (name, False, asked.lines(mine), _marked(more.take(more.count > 0))),
            (name, False, drawn, _marked(uncovered(drawn, near.near()))),
        ]
    return found


def _marked(parts: Stretches) -> Stretches:
    return parts.take(parts.lengths > tolerances.UNEVEN_MM)


def _error(code: str, where: str, message: str, remedy: str = "") -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)


def _unassigned(asked: Asked) -> list[Finding]:
    count = int(asked.has(Assignment.U).sum())
    if not count or asked.plan.unassigned is not None:
        return []
    text = f"{count} creases are neither mountain nor valley, and the plan does not say on which "
    return [_error("unassigned", "plan", f"{text}face they are scored.", "Plan with --unassigned.")]


def _coverage(asked: Asked, which: Flags, drawn: Pieces) -> tuple[Pairs, Stretches]:
    """Return how often strokes run along the chosen edges, whose numbers the stretches carry."""
    found = pairs(drawn, asked.lines(which), tolerances.PLAN_MM)
    return found, found.along()[1]


def _on_wrong_face(asked: Asked, drawn: Sequence[Pieces]) -> Flags:
    """Tell which edges are scored along most of their length on the face they do not belong on."""
    wrong = np.zeros(len(asked.lengths), bool)
    usual = rows.share(asked.plan.material.score)
    for face in (0, 1):
        share = [np.zeros(len(wrong)), np.zeros(len(wrong))]
        for side in (0, 1):
            _, along = _coverage(asked, asked.score_face == face, drawn[side])
            share[side] = along.total(len(wrong)) / asked.lengths / usual
        wrong |= (share[1 - face] > 0.5) & (share[face] < 0.5)
    return wrong


def _swapped(asked: Asked) -> Finding:
    rule = asked.plan.material.score.score_face
    where = {
        "outside": "A half-cut opens on the outside of the fold: mountains belong on the front, "
        "valleys on the reverse.",
        "inside": "A crease pressed into the inside: mountains belong on the reverse, valleys on "
        "the front.",
        "either": "What works either way is scored on the reverse.",
    }[rule]
    return _error(
        "swapped-faces",
        "plan",
        "Mountains and valleys are swapped: every crease is scored on the wrong face.",
        where,
    )


def _wrong_face(asked: Asked, edge: int) -> Finding:
    own = int(asked.score_face[edge])
    text = f"It is scored on the {FACES[1 - own]}; it belongs on the {FACES[own]}."
    return _error("wrong-face", asked.name(edge), text)


def _missing(asked: Asked, face: int, drawn: Pieces, wrong: Flags) -> list[Finding]:
    """Find creases of a face that are scored not at all or in part."""
    mine = (asked.score_face == face) & ~wrong
    _, along = _coverage(asked, mine, drawn)
    _, most = asked.setbacks
    found = []
    required = _between(mine, most[:, 0], asked.lengths - most[:, 1])
    for edge, low, high, _ in _long(difference(along, required), -1):
        whole = high - low >= asked.lengths[edge] - most[edge].sum() - tolerances.UNEVEN_MM
        part = "It is not scored" if whole else f"{high - low:.2f} mm of it are not scored"
        text = f"{part} on the {FACES[face]}."
        found.append(_error("missing-score", asked.name(edge), text))
    return found


def _too_much(asked: Asked, face: int, drawn: Pieces, wrong: Flags) -> list[Finding]:
    """Find creases of a face that are scored twice, or into a vertex."""
    mine = (asked.score_face == face) & ~wrong
    _, along = _coverage(asked, mine, drawn)
    least, _ = asked.setbacks
    found = []
    allowed = _between(mine, least[:, 0], asked.lengths - least[:, 1])
    for edge, low, high, _ in _long(difference(along, allowed), 1):
        if least[edge, 0] < (low + high) / 2 < asked.lengths[edge] - least[edge, 1]:
            text = f"{high - low:.2f} mm of it are scored twice on the {FACES[face]}."
            found.append(_error("scored-twice", asked.name(edge), text))
        elif not isinstance(asked.plan.material.score, Perforation):  # rows tell of their own ends
            setback = least[edge].max()
            text = f"Its score runs {high - low:.2f} mm into the setback of {setback:g} mm."
            found.append(_error("setback", asked.name(edge), text))
    return found


def _between(which: Flags, low: Floats, high: Floats) -> Stretches:
    """Return one stretch for each chosen edge, from low to high mm; none where that is nothing."""
    edges = np.flatnonzero(which & (high > low))
    return Stretches(edges, low[edges], high[edges], np.ones(len(edges)))


def _long(parts: Stretches, sign: int) -> list[tuple[int, float, float, float]]:
    kept = parts.take((parts.lengths > tolerances.UNEVEN_MM) & (np.sign(parts.count) == sign))
    return list(
        zip(
            kept.line.tolist(),
            kept.low.tolist(),
            kept.high.tolist(),
            kept.count.tolist(),
            strict=True,
        )
    )


def _stray(
    asked: Asked, face: int, drawn: Pieces, strokes: Sequence[Planned], wrong: Flags
) -> list[Finding]:
    """Find scores where no crease of this face is, and say what is there instead."""
    found = pairs(drawn, asked.lines(asked.score_face == face), tolerances.PLAN_MM)
    stray = uncovered(drawn, found.near())
    stray = stray.take(stray.lengths > max(COINCIDENT_MM, tolerances.UNEVEN_MM))
    findings = []
    for line, low, high, _ in _long(stray, -1):
        ends = np.array([[drawn.at(line, low), drawn.at(line, high)]])
        there = _edge_under(asked, ends)
        if there is not None and wrong[there]:
            continue  # told of the crease already
        findings.append(_stray_finding(asked, strokes[line], ends[0], there))
    return findings


def _edge_under(asked: Asked, ends: Floats) -> int | None:
    """Return the edge that a straight line (1, 2, 2) runs along most; None for none."""
    line = Pieces(ends, np.zeros(1, np.intp), np.zeros(1))
    everything = asked.lines(np.ones(len(asked.lengths), bool))
    _, along, _, _ = pairs(line, everything, tolerances.PLAN_MM).along()
    return int(along.line[np.argmax(along.lengths)]) if len(along.line) else None


def _stray_finding(asked: Asked, stroke: Planned, ends: Floats, edge: int | None) -> Finding:
    where = f"{stroke} on the {stroke.face}"
    line = f"{at(ends[0])} to {at(ends[1])}"
    if edge is None:
        text = f"It is scored from {line}, where the pattern has no line."
        return _error("no-such-line", where, text)
    if asked.score_face[edge] == NOWHERE:
        return _error("not-to-score", where, f"It scores the {asked.name(edge)}.")
    text = f"It scores the {asked.name(edge)}, which belongs on the other face."
    return _error("scored-on-both", where, text)
