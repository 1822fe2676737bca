"""A slit has no width: two banks at one place, which are one cut once it is sewn up."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from foldmill import Assignment, CreasePattern, Fold
from foldmill.check import planarity
from foldmill.exchange import fold as fold_file
from foldmill.slits import banks, sewn

# A square of 100 mm, slit from the middle of its lower side (0 and 1, one vertex on each bank) to
# its middle (2); creases run on from there.
CORNERS = [(50, 0), (50, 0), (50, 50), (0, 0), (0, 100), (50, 100), (100, 100), (100, 0)]
FACES = [(3, 0, 2), (3, 2, 4), (4, 2, 5), (5, 2, 6), (6, 2, 7), (7, 2, 1)]
LEFT, RIGHT = (0, 2), (1, 2)


def pattern(vertices: list[Any] = CORNERS, faces: list[Any] = FACES) -> CreasePattern:
    """Return the sheet of some triangles, all its creases flat."""
    sides = [(f[k], f[(k + 1) % 3]) for f in faces for k in range(3)]
    known = {tuple(sorted(side)) for side in sides}
    edges = sorted(known, key=lambda edge: (set(edge) == set(RIGHT), edge))
    twice = {edge for edge in known if edge in sides and edge[::-1] in sides}
    codes = [Assignment.F if edge in twice else Assignment.B for edge in edges]
    none = np.zeros(len(edges))
    return CreasePattern(vertices, edges, np.array(codes), none, faces)  # type: ignore[arg-type]


def codes_of(fold: Fold) -> set[str]:
    return {finding.code for finding in planarity(fold).findings}


def moved(vertex: int, by: tuple[float, float]) -> CreasePattern:
    spots = [tuple(spot) for spot in CORNERS]
    x, y = spots[vertex]
    return pattern([*spots[:vertex], (x + by[0], y + by[1]), *spots[vertex + 1 :]])


def test_the_banks_are_found_and_sewn_up_to_one_inner_cut() -> None:
    opened = pattern()
    ends = [{tuple(opened.edges[edge].tolist()) for edge in pair} for pair in banks(opened)]
    assert ends == [{LEFT, RIGHT}]
    closed = sewn(opened)
    assert closed.pairs.tolist() == [[0, 1]]
    assert closed.pattern.count(Assignment.C) == 1
    assert closed.pattern.count(Assignment.B) == opened.count(Assignment.B) - 2
    assert len(closed.pattern.edges) == len(opened.edges) - 1
    assert closed.edges.tolist() == list(range(len(opened.edges) - 1))
    cut = closed.pattern.edges[closed.pattern.assignments == Assignment.C][0]
    assert cut.tolist() == list(LEFT)
    assert (closed.pattern.edge_faces[closed.pattern.assignments == Assignment.C] >= 0).all()


def test_a_sheet_with_a_slit_is_a_sheet() -> None:
    report = planarity(Fold(pattern()))
    assert not report.findings
    assert (report.figures["slits"], report.figures["outline_loops"]) == (1, 1)
    assert (report.figures["area_mm2"], report.figures["area_gap_mm2"]) == (10_000, 0)


def test_a_slit_that_gapes_is_an_outline_and_no_slit() -> None:
    gaping = moved(1, (2.0, 0.0))
    assert not len(banks(gaping))
    assert sewn(gaping).pattern is gaping
    assert not planarity(Fold(gaping)).findings


@pytest.mark.parametrize("by", [(-2.0, 0.0), (-0.001, 0.0), (-1e-5, 0.0)])
def test_a_bank_that_lies_upon_the_other_bank_is_paper_upon_paper(by: tuple[float, float]) -> None:
    assert codes_of(Fold(moved(1, by))) >= {"outline"}


def test_edges_upon_each_other_with_paper_on_one_side_are_no_slit() -> None:
    """The sheet goes round its middle once and a half."""
    more = [*CORNERS, (0, 0), (0, 100), (50, 100)]
    faces = [*FACES[:-1], (7, 2, 1), (1, 2, 8)]
    over = pattern([*more[:1], (50, 0), *more[2:]], [*faces[:-1], (8, 1, 2), (8, 2, 9), (9, 2, 10)])
    assert not len(banks(over))
    assert "coincident-vertices" in codes_of(Fold(over))


def test_a_cut_from_side_to_side_leaves_no_sheet() -> None:
    two = [(0, 0), (50, 0), (50, 100), (0, 100), (50, 0), (100, 0), (100, 100), (50, 100)]
    apart = pattern(two, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
    assert len(banks(apart)) == 1
    assert "outline" in codes_of(Fold(apart))


def test_a_pattern_without_slits_stays_itself() -> None:
    whole = CreasePattern.from_lines(
        [[0, 0], [9, 0], [9, 9], [0, 9]], [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]], "BBBBM"
    )
    closed = sewn(whole)
    assert closed.pattern is whole
    assert closed.edges.tolist() == [0, 1, 2, 3, 4]
    assert closed.pairs.shape == (0, 2)


def test_a_file_keeps_both_banks() -> None:
    fold = Fold(pattern())
    text = fold_file.write(fold)
    again = fold_file.read(text)
    assert again.pattern.letters() == fold.pattern.letters()
    assert np.array_equal(again.pattern.edges, fold.pattern.edges)
    assert np.array_equal(banks(again.pattern), banks(fold.pattern))
    assert fold_file.write(again) == text
