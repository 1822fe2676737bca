"""What one program draws against the strokes it must draw: nothing missing, extra, or too often."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill.tolerances import COINCIDENT_MM
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.cover import (
    Pairs,
    Pieces,
    Stretches,
    difference,
    pairs,
    pieces,
    uncovered,
)
from foldmill_fabricate.verify.planned import Planned, at, wanted_counts
from foldmill_fabricate.verify.virtual_sheet import Line, modelled_offset

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_MANY = 100
"""Beyond this many, stray lines have a common cause, and matching them one by one says nothing."""


@dataclass(frozen=True, eq=False)
class Drawing:
    """The lines a program drew, beside the strokes it was to draw."""

    plan: Plan
    name: str
    """The program's name, for findings."""
    lines: Sequence[Line]
    strokes: Sequence[Planned]

    @property
    def step(self) -> float:
        """One plotter step, mm."""
        return 1 / self.plan.machine.axes.units_per_mm

    @property
    def tolerance(self) -> float:
        """How far what is drawn may lie from the plan, mm."""
        return self.step + (tolerances.BLADE_MM if modelled_offset(self.plan.machine) > 0 else 0.0)

    @cached_property
    def drawn(self) -> Pieces:
        """The drawn lines' pieces."""
        return pieces([line.points for line in self.lines])

    @cached_property
    def wanted(self) -> Pieces:
        """The strokes' pieces."""
        return pieces([stroke.points for stroke in self.strokes])

    @cached_property
    def _pairs(self) -> Pairs:
        return pairs(self.drawn, self.wanted, self.tolerance)

    @cached_property
    def extra(self) -> Stretches:
        """Stretches of drawn lines that no stroke asks for."""
        return _real(uncovered(self.drawn, self._pairs.near()))

    @cached_property
    def missing(self) -> Stretches:
        """Stretches of strokes that nothing was drawn on."""
        found = self._pairs
        mirrored = Pairs(found.those, found.these, found.j, found.i, found.tolerance)
        return _real(uncovered(self.wanted, mirrored.near()))

    @cached_property
    def _along(self) -> tuple[Stretches, Stretches, Indices, Indices]:
        return self._pairs.along()

    @cached_property
    def strokes_of_pieces(self) -> Indices:
        """The stroke that each drawn piece goes along most; -1 for none."""
        on_drawn, on_wanted, i, _ = self._along
        best = np.full(len(self.drawn.line), -1, np.intp)
        order = np.argsort(on_drawn.lengths, kind="stable")
        best[i[order]] = on_wanted.line[order]
        return best

    @cached_property
    def strokes_of_lines(self) -> Indices:
        """The stroke that each drawn line goes along most; -1 for none."""
        known = self.strokes_of_pieces >= 0
        line, owner = self.drawn.line[known], self.strokes_of_pieces[known]
        pair, inverse = np.unique(np.stack([line, owner], axis=1), axis=0, return_inverse=True)
        shared = np.bincount(inverse, self.drawn.lengths[known], minlength=len(pair))
        best = np.full(len(self.lines), -1, np.intp)
        order = np.argsort(shared, kind="stable")
        best[pair[order, 0]] = pair[order, 1]
        return best

    @cached_property
    def deviation(self) -> float:
        """How far any corner of either lies from the other, mm; 0 where one of them is empty."""
        if not len(self.drawn.line) or not len(self.wanted.line):
            return 0.0
        found = self._pairs
        return max(
            _farthest(self.drawn, self.wanted, found.i, found.j, self.tolerance),
            _farthest(self.wanted, self.drawn, found.j, found.i, self.tolerance),
        )

    def forget(self) -> None:
        """Keep the lines and what was measured; the rest, which is large, is found anew if asked.

        The trees over all pieces of a large sheet would else be held for every program of a job.
        """
        kept = {*self.__dataclass_fields__, "deviation"}
        for name in set(vars(self)) - kept:
            del vars(self)[name]

    def faulty_share(self) -> float:
        """Return which share of what was to be drawn is missing or was drawn elsewhere."""
        whole = float(self.wanted.lengths.sum())
        repeated = float(self.drawn.lengths.sum())
        missing = float(self.missing.lengths.sum()) / whole if whole else 0.0
        extra = float(self.extra.lengths.sum()) / repeated if repeated else 0.0
        return max(missing, extra)

    def findings(self, known: set[int]) -> list[Finding]:
        """Say stroke by stroke what is missing, moved, extra, or done too often or too rarely.

        known : numbers of stray lines that somebody has spoken of already.
        """
        moved = self.moved
        beside = {line for lines in moved.values() for line in lines}
        found = [self._say("moved", k, self._off(k, lines)) for k, lines in moved.items()]
        found += self._missing_findings(set(moved))
        found += self._extra_findings(known | beside)
        return found + self._count_findings(set(moved))

    def _say(self, code: str, stroke: int, message: str) -> Finding:
        planned = self.strokes[stroke]
        where = f"{self.name}, {planned} at {at(planned.points[0])}"
        return Finding(code, Severity.ERROR, where, message)

    @cached_property
    def moved(self) -> dict[int, tuple[int, ...]]:
        """Lost strokes and the stray lines close beside each: one fault instead of two."""
        import shapely

        extra = [int(k) for k in np.unique(self.extra.line) if len(self.lines[k].points) > 1]
        if not extra or len(extra) > _MANY:
            return {}
        tracks = np.array([shapely.LineString(self.lines[k].points) for k in extra])
        found = {}
        for stroke in np.unique(self.missing.line).tolist():
            way = shapely.LineString(self.strokes[stroke].points)
            near = np.flatnonzero(shapely.hausdorff_distance(tracks, way) < tolerances.BESIDE_MM)
            if len(near):
                found[stroke] = tuple(extra[k] for k in near)
        return found

    def _off(self, stroke: int, lines: tuple[int, ...]) -> str:
        import shapely

        tracks = np.array([shapely.LineString(self.lines[k].points) for k in lines])
        way = shapely.LineString(self.strokes[stroke].points)
        return (
            f"The stroke lies up to {shapely.hausdorff_distance(tracks, way).max():.3f} mm off its "
            f"place; {self.tolerance:.3f} mm is allowed."
        )

    def _missing_findings(self, moved: set[int]) -> list[Finding]:
        found = []
        for line, low, high in _rows(self.missing):
            if line in moved:
                continue
            if high - low >= self.strokes[line].length - 2 * self.tolerance:
                text = f"The stroke of {high - low:.2f} mm is missing."
            else:
                ends = at(self.wanted.at(line, low)), at(self.wanted.at(line, high))
                text = f"{high - low:.2f} mm are not drawn, from {ends[0]} to {ends[1]}."
            found.append(self._say("missing-stroke", line, text))
        return found

    def _extra_findings(self, known: set[int]) -> list[Finding]:
        found = []
        for line, rows in _grouped(_rows(self.extra)).items():
            if line in known:
                continue
            low, high = max(rows, key=lambda row: row[1] - row[0])
            ends = at(self.drawn.at(line, low)), at(self.drawn.at(line, high))
            where = f"{self.name}, byte {self.lines[line].run.byte}"
            line_text = f"{high - low:.2f} mm from {ends[0]} to {ends[1]}"
            text = f"It draws {line_text}, where no stroke is{_times(rows)}."
            found.append(Finding("extra-line", Severity.ERROR, where, text))
        return found

    def _count_findings(self, known: set[int]) -> list[Finding]:
        _, on_wanted, _, _ = self._along
        wanted = wanted_counts(self.strokes)
        uneven = difference(on_wanted, wanted)
        slack = tolerances.SLACK_STEPS * self.step
        blade = tolerances.SLACK_BLADE * (self.tolerance - self.step)
        long = uneven.take(uneven.lengths > max(slack, 2 * self.tolerance, blade))
        lost = set(self.missing.line.tolist())
        found = []
        for line, rows in _grouped(_rows(long)).items():
            times = float(long.count[long.line == line][0])
            repeats = self.strokes[line].operation.repeats
            if line in known or (line in lost and times <= -repeats):
                continue
            length = sum(high - low for low, high in rows)
            ends = at(self.wanted.at(line, rows[0][0])), at(self.wanted.at(line, rows[-1][1]))
            text = (
                f"It is gone over {_often(times)} than its {repeats} repeats say, over "
                f"{length:.2f} mm from {ends[0]} to {ends[1]}."
            )
            found.append(self._say("repeats", line, text))
        return found + self._sum_findings(known | lost | set(long.line.tolist()))

    def _sum_findings(self, told: set[int]) -> list[Finding]:
        """Catch what short facets hide: rounding breaks a round too many into short stretches."""
        known = self.strokes_of_pieces >= 0
        owner, lengths = self.strokes_of_pieces[known], self.drawn.lengths[known]
        totals = np.bincount(owner, lengths, minlength=len(self.strokes))
        found = []
        for k, stroke in enumerate(self.strokes):
            wanted = stroke.operation.repeats * stroke.length + stroke.overcut
            over = float(totals[k]) - wanted
            if k not in told and abs(over) > max(stroke.length / 2, self.tolerance):
                text = f"In all {totals[k]:.2f} mm are drawn; its repeats ask for {wanted:.2f} mm."
                found.append(self._say("repeats", k, text))
        return found


def _real(parts: Stretches) -> Stretches:
    return parts.take(parts.lengths > COINCIDENT_MM)


def _rows(parts: Stretches) -> list[tuple[int, float, float]]:
    return list(zip(parts.line.tolist(), parts.low.tolist(), parts.high.tolist(), strict=True))


def _grouped(rows: list[tuple[int, float, float]]) -> dict[int, list[tuple[float, float]]]:
    groups: dict[int, list[tuple[float, float]]] = {}
    for line, low, high in rows:
        groups.setdefault(line, []).append((low, high))
    return groups


def _times(rows: list[tuple[float, float]]) -> str:
    return f", and on {len(rows) - 1} more stretches" if len(rows) > 1 else ""


def _often(times: float) -> str:
    many = "once" if abs(times) == 1 else f"{abs(times):.0f} times"
    return f"{many} {'more' if times > 0 else 'less'}"


def _farthest(these: Pieces, those: Pieces, i: Indices, j: Indices, near: float) -> float:
    """Return how far any end of these pieces lies from those, mm.

    i, j : the pairs that come nearer than ``near``; for other ends all are looked through.
    """
    gaps = np.full((len(these.line), 2), np.inf)
    for end in (0, 1):
        np.minimum.at(gaps[:, end], i, _gaps(these.ends[i, end], those.ends[j]))
    lost = gaps > near
    if lost.any():
        gaps[lost] = _any_gaps(these.ends[lost], those)
    return float(gaps.max())


def _gaps(points: Floats, ends: Floats) -> Floats:
    """Return the distances (n,) of points (n, 2) from straight pieces (n, 2, 2)."""
    course, arm = ends[:, 1] - ends[:, 0], points - ends[:, 0]
    share = np.clip((arm * course).sum(axis=1) / (course * course).sum(axis=1), 0.0, 1.0)
    gaps: Floats = np.hypot(*(arm - share[:, None] * course).T)
    return gaps


def _any_gaps(points: Floats, those: Pieces) -> Floats:
    """Return the distances (n,) of points (n, 2) from the nearest of all pieces."""
    import shapely

    nearest = np.zeros(len(points))
    found, gaps = those.tree.query_nearest(
        shapely.points(points), all_matches=False, return_distance=True
    )
    nearest[found[0]] = gaps
    return nearest
