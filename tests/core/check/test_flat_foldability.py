"""Kawasaki and Maekawa at a vertex: known vertices, and the paper model in the test."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from foldmill import CreasePattern, Fold
from foldmill.check.flat_foldability import flat_foldability, flat_vertex
from foldmill.exchange import read

SAMPLES = Path(__file__).parents[2] / "samples"


def star(*angles: float) -> tuple[np.ndarray, np.ndarray]:
    """Return creases from the origin, each 1 mm long, at these angles in deg."""
    around = np.radians(angles)
    points = np.vstack([[0, 0], np.column_stack([np.cos(around), np.sin(around)])])
    return points, np.array([(0, k + 1) for k in range(len(angles))])


def gap_by_folding(points: np.ndarray, edges: np.ndarray) -> float:
    """Fold round the vertex: a reflection at each crease; return the turn that is left, deg."""
    turn = np.eye(2)
    for x, y in sorted(points[edges[:, 1]], key=lambda p: float(np.arctan2(p[1], p[0]))):
        turn = turn @ np.array([[x * x - y * y, 2 * x * y], [2 * x * y, y * y - x * x]])
    return abs(float(np.degrees(np.arctan2(turn[1, 0], turn[0, 0]))))


def test_a_birds_foot_folds_flat_and_with_two_and_two_it_does_not() -> None:
    points, edges = star(0, 60, 180, 300)
    foot = flat_vertex(points, edges, 0, [1, 1, -1, 1])
    assert foot.holds
    assert (foot.creases, foot.mountains_minus_valleys) == (4, -2)
    assert foot.kawasaki_deg == pytest.approx(0, abs=1e-12)
    assert not flat_vertex(points, edges, 0, [1, -1, 1, -1]).holds


def test_the_kawasaki_gap_is_half_the_turn_that_reflections_leave() -> None:
    rng = np.random.default_rng(3)
    for _ in range(200):
        points, edges = star(*rng.uniform(0, 360, 2 * int(rng.integers(1, 5))))
        gap = flat_vertex(points, edges, 0, np.ones(len(edges))).kawasaki_deg
        left = gap_by_folding(points, edges)
        assert min(abs(2 * gap - left), abs(360 - 2 * gap - left)) < 1e-9


def test_a_crease_that_stays_flat_is_not_there() -> None:
    points, edges = star(0, 60, 100, 180, 300)
    assert flat_vertex(points, edges, 0, [1, 1, 0, -1, 1]).holds
    odd = flat_vertex(points, edges, 0, [1, 1, 1, -1, 1])
    assert (odd.kawasaki_deg, odd.holds) == (180, False)
    assert flat_vertex(points, edges, 0, np.zeros(5)).holds


@pytest.mark.parametrize("name", ["ff_pinwheel", "ff_bad-twist-UNSAT"])
def test_a_pattern_known_to_be_flat_at_every_vertex_passes(name: str) -> None:
    report = flat_foldability(read((SAMPLES / f"{name}.fold").read_text("utf-8"), name))
    assert not report.findings
    assert report.figures["flat_foldable_vertices"] == report.figures["inner_vertices"] != 0


def test_one_mountain_turned_valley_is_found_and_named() -> None:
    fold = read((SAMPLES / "ff_pinwheel.fold").read_text("utf-8"), "pinwheel")
    pattern = fold.pattern
    letters = list(pattern.letters())
    turned = letters.index("M")
    letters[turned] = "V"
    other = CreasePattern.from_lines(pattern.vertices, pattern.edges, "".join(letters))
    found = flat_foldability(Fold(other)).findings
    inner = set(pattern.interior_vertices.tolist()) & set(pattern.edges[turned].tolist())
    assert len(found) == len(inner) > 0
    assert {each.code for each in found} == {"maekawa"}
    assert "not 2 or −2" in found[0].message
