"""The outline is cut but for its declared ties, inner cuts wholly, and nothing else is cut."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment
from foldmill.finding import Finding, Severity
from foldmill_fabricate.materials import ThroughCut
from foldmill_fabricate.passes import Face, Role, Tie
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.cover import (
    Pieces,
    Stretches,
    difference,
    pairs,
    pieces,
    stretches,
    uncovered,
)
from foldmill_fabricate.verify.eased import LEAST_TIES, Eased
from foldmill_fabricate.verify.planned import Planned, at

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


def prove_cuts(asked: Asked, strokes: Sequence[Planned]) -> list[Finding]:
    """Compare the cut strokes with outline, inner cuts and ties."""
    outer = [stroke for stroke in strokes if stroke.role is Role.CUT_OUTER]
    inner = [stroke for stroke in strokes if stroke.role is Role.CUT_INNER]
    loops = asked.has(Assignment.B) & ~asked.rim
    found = _compare(asked, outer, asked.rim, asked.plan.ties)
    found += _compare(asked, inner, asked.has(Assignment.C) | loops, ())
    return found + _tie_findings(asked)


def _error(code: str, where: str, message: str, remedy: str = "") -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)


def astray(asked: Asked, strokes: Sequence[Planned]) -> list[tuple[Face, bool, Pieces, Stretches]]:
    """Return stretches that are not cut (True), and that are and should not be (False)."""
    loops = asked.has(Assignment.B) & ~asked.rim
    last = asked.plan.passes[-1].face if asked.plan.passes else Face.FRONT
    found = []
    for role, which, ties in (
        (Role.CUT_OUTER, asked.rim, asked.plan.ties),
        (Role.CUT_INNER, asked.has(Assignment.C) | loops, ()),
    ):
        drawn, edges = pieces([s.points for s in strokes if s.role is role]), asked.lines(which)
        uneven, stray = _differences(asked, drawn, which, _bridges(asked, which, ties))
        found += [
            (last, True, edges, uneven.take(uneven.count < 0)),
            (last, False, edges, uneven.take(uneven.count > 0)),
            (last, False, drawn, stray),
        ]
    return found


def _differences(
    asked: Asked, drawn: Pieces, which: Flags, bridges: Stretches
) -> tuple[Stretches, Stretches]:
    """Return where edges are cut too often (+) or not at all (-), and what is cut besides."""
    edges = asked.lines(which)
    found = pairs(drawn, edges, tolerances.PLAN_MM)
    _, along, _, _ = found.along()
    whole = Stretches(edges.line, edges.start, edges.lengths, np.ones(len(edges.line)))
    uneven = difference(along, difference(whole, bridges))
    stray = uncovered(drawn, found.near())
    long = tolerances.UNEVEN_MM
    return uneven.take(uneven.lengths > long), stray.take(stray.lengths > long)


def _compare(
    asked: Asked, strokes: Sequence[Planned], which: Flags, ties: Sequence[Tie]
) -> list[Finding]:
    drawn = pieces([stroke.points for stroke in strokes])
    bridges = _bridges(asked, which, ties)
    uneven, stray = _differences(asked, drawn, which, bridges)
    findings = [
        _uneven_finding(asked, *row, bridges)
        for row in zip(
            uneven.line.tolist(),
            uneven.low.tolist(),
            uneven.high.tolist(),
            uneven.count.tolist(),
            strict=True,
        )
    ]
    for line, low, high in zip(stray.line.tolist(), stray.low, stray.high, strict=True):
        ends = at(drawn.at(line, low)), at(drawn.at(line, high))
        text = f"It cuts from {ends[0]} to {ends[1]}, where the pattern has no such cut."
        findings.append(_error("no-such-line", str(strokes[line]), text))
    return findings


def _bridges(asked: Asked, which: Flags, ties: Sequence[Tie]) -> Stretches:
    """Return the stretches of edges that ties leave standing: within half a width of the middle."""
    items = []
    edges = np.flatnonzero(which)
    a, b = asked.ends[edges, 0], asked.ends[edges, 1]
    course = (b - a) / asked.lengths[edges][:, None]
    for tie in ties:
        to_tie = np.array([tie.x, tie.y]) - a
        place = (to_tie * course).sum(axis=1)
        beside = to_tie[:, 0] * course[:, 1] - to_tie[:, 1] * course[:, 0]
        half = np.sqrt(np.maximum((tie.width / 2) ** 2 - beside**2, 0.0))
        low = np.maximum(place - half, 0.0)
        high = np.minimum(place + half, asked.lengths[edges])
        touched = np.flatnonzero(high > low)
        items += [(int(edges[k]), float(low[k]), float(high[k]), 1.0) for k in touched]
    return stretches(items)


def _uneven_finding(
    asked: Asked, edge: int, low: float, high: float, times: float, bridges: Stretches
) -> Finding:
    course = asked.ends[edge, 1] - asked.ends[edge, 0]
    ends = [at(asked.ends[edge, 0] + s / asked.lengths[edge] * course) for s in (low, high)]
    line = f"{high - low:.2f} mm from {ends[0]} to {ends[1]}"
    if times < 0:
        text = f"{line} are not cut, and no tie is declared there."
        return _error("missing-cut", asked.name(edge), text)
    middle = (low + high) / 2
    bridged = (bridges.line == edge) & (bridges.low <= middle) & (bridges.high >= middle)
    if bridged.any():
        return _error("tie-cut", asked.name(edge), f"The tie declared over {line} is cut through.")
    return _error("cut-twice", asked.name(edge), f"{line} are cut twice.")


def _tie_findings(asked: Asked) -> list[Finding]:
    ties = asked.plan.ties
    found = []
    cut = asked.plan.material.cut
    if not asked.rim.any():
        return [_error("no-outline", "pattern", "The pattern has no outline to cut.")]
    if not isinstance(cut, ThroughCut):
        text = f"The outline is made by {cut.title}; there is nothing for a tie to hold."
        return [_error("ties-unasked", "outline", text)] if ties else []
    owners = [_owner(asked, tie) for tie in ties]
    corners, eased = _corners(asked), [Eased(asked, cut, loop) for loop in asked.loops]
    for copy in range(asked.laid.count):
        found += _enough(asked, cut, copy, owners.count(copy))
        held = [tie for tie, owner in zip(ties, owners, strict=True) if owner == copy]
        found += _spread(eased[copy], held, copy)
    for k, tie in enumerate(ties, 1):
        own = eased[max(owners[k - 1], 0)]
        found += _one_tie(own, tie, f"tie {k} at {at((tie.x, tie.y))}", corners)
    return found


def _owner(asked: Asked, tie: Tie) -> int:
    """Return the copy, 0, 1, 2 …, that a tie holds; of one part, that one; -1 where none."""
    if asked.laid.count == 1:
        return 0
    standing = _bridges(asked, asked.rim, [tie])
    return asked.laid.split(int(standing.line[0]))[0] if len(standing.line) else -1


def _enough(asked: Asked, cut: ThroughCut, copy: int, count: int) -> list[Finding]:
    """Check that a copy hangs on as many ties as it needs."""
    where = "outline" if asked.laid.count == 1 else f"outline of copy {copy + 1}"
    if count < LEAST_TIES:
        text = f"The outline has {count} ties; a part needs {LEAST_TIES} to stay in place."
        return [_error("too-few-ties", where, text)]
    own = asked.laid.edges_of(copy)
    around = float(asked.lengths[own][asked.rim[own]].sum())
    usual = int(around / cut.tie_pitch)
    if count < usual:
        text = f"{count} ties hold an outline of {around:.0f} mm; {usual} are usual."
        return [Finding("few-ties", Severity.WARNING, where, text)]
    return []


def _spread(eased: Eased, ties: Sequence[Tie], copy: int) -> list[Finding]:
    """Check that ties hold a copy all round it, not on one side."""
    if len(ties) < LEAST_TIES or (unheld := eased.unheld(ties)) is None:
        return []
    away, spot = unheld
    where = "outline" if eased.asked.laid.count == 1 else f"outline of copy {copy + 1}"
    text = f"The edge at {at(spot)} has room for a tie, and the nearest one is {away:.1f} mm along "
    text += f"the outline from it; {eased.cut.tie_pitch:g} mm are usual: the part may swing out."
    return [_error("ties-bunched", where, text)]


def _one_tie(eased: Eased, tie: Tie, where: str, corners: Floats) -> list[Finding]:
    asked, cut = eased.asked, eased.cut
    bridge = _bridges(asked, asked.rim, [tie])
    standing = float(bridge.lengths.sum())
    if standing < tie.width - tolerances.UNEVEN_MM:
        text = f"Only {standing:.2f} mm of its {tie.width:g} mm lie on the outline."
        return [_error("tie-astray", where, text)]
    found = []
    if abs(tie.width - cut.tie_width) > tolerances.UNEVEN_MM:
        text = f"It is {tie.width:g} mm wide; the material asks for {cut.tie_width:g} mm."
        found.append(_error("tie-width", where, text))
    gaps = np.hypot(*(corners - (tie.x, tie.y)).T) - tie.width / 2
    if len(gaps) and gaps.min() < cut.tie_corner - tolerances.UNEVEN_MM:
        text = f"It is {gaps.min():.2f} mm from a corner; {cut.tie_corner:g} mm are asked for"
        why = eased.objection(tie)
        found.append(
            _error("tie-corner", where, f"{text}, and {why}.") if why else _near(where, text)
        )
    return found


def _near(where: str, text: str) -> Finding:
    text = f"{text}, and the outline has no better place near it."
    return Finding("tie-near-corner", Severity.WARNING, where, text)


def _corners(asked: Asked) -> Floats:
    """Return the corners (n, 2) of the outlines, mm: where one turns by more than a named angle.

    Where an inner cut comes out is a corner too.
    """
    found = [asked.mouths]
    for loop in asked.loops:
        rim = asked.spots[loop]
        before, after = rim - np.roll(rim, 1, axis=0), np.roll(rim, -1, axis=0) - rim
        cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
        turn = np.degrees(np.abs(np.arctan2(cross, (before * after).sum(axis=1))))
        found.append(rim[turn > tolerances.CORNER_DEG])
    return np.vstack(found)
