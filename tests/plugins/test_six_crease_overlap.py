"""An overlap along a seam of six-crease bases lies upon the first facets, creases and all."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely
from six_crease_oracle import random_design
from stools import ONE_TOOL, machine, material
from tubes import FACES, SHAPES, WHOLE, closed_by, space

from foldmill import Assignment, Fold, ImpossibleGeometry, InvalidParameters
from foldmill.check import assignment, check, developability, isometry, planarity
from foldmill.check.intersection import penetrations
from foldmill_fabricate.plan import make
from foldmill_plugins.six_crease import DESIGN

CHOICES = pytest.mark.parametrize(("width", "taper"), [(2, 0), (3, 30), (4, 60), (9.5, 10)])
RULES = (planarity, developability, isometry, assignment)


def overlapped(name: str, width: float, taper: float = 30, **values: Any) -> Fold:
    return closed_by("overlap", name, width, taper, **values)


@SHAPES
@CHOICES
def test_a_sheet_with_an_overlap_is_one_sheet_that_folds_through_nothing(
    name: str, width: float, taper: float
) -> None:
    fold = overlapped(name, width, taper)
    report = check(fold)
    assert not report.findings
    assert float(report.figures["isometry"]) <= 1e-12
    assert len(fold.pattern.outline()) == 1
    assert np.ptp(fold.pattern.vertices[:, 0]) == pytest.approx(200 + width)
    assert not len(penetrations(space(fold), fold.pattern.edges, fold.pattern.faces))
    triangles = shapely.polygons(fold.pattern.vertices[fold.pattern.faces])
    area = float(shapely.area(triangles).sum())
    assert area == pytest.approx(shapely.area(shapely.union_all(triangles)), rel=1e-12)


@SHAPES
@CHOICES
def test_every_spot_of_the_overlap_is_where_the_first_facets_are(
    name: str, width: float, taper: float
) -> None:
    """Map the overlap back by 2·N·w in the pattern: in space it is where the facet there is."""
    fold = overlapped(name, width, taper)
    pattern, places = fold.pattern, space(fold)
    beyond = np.sign(pattern.vertices[WHOLE, 0]) * np.array([200.0, 0.0])
    for face in pattern.faces[FACES:]:
        for share in np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (0.3, 0.3, 0.4)]):
            flat = share @ pattern.vertices[face] - beyond
            assert np.abs(held_at(fold, flat) - share @ places[face]).max() <= 1e-11


def held_at(fold: Fold, spot: np.ndarray) -> np.ndarray:
    """Return where the tube's own facet holds a spot of the pattern."""
    for face in fold.pattern.faces[:FACES]:
        a, b, c = fold.pattern.vertices[face]
        beta, gamma = np.linalg.solve(np.column_stack([b - a, c - a]), spot - a)
        if min(beta, gamma, 1 - beta - gamma) >= -1e-9:
            held: np.ndarray = np.array([1 - beta - gamma, beta, gamma]) @ space(fold)[face]
            return held
    raise AssertionError(spot)


@SHAPES
def test_its_creases_continue_those_that_it_lies_upon(name: str) -> None:
    fold = overlapped(name, 6.0, 0.0)
    pattern = fold.pattern
    middles = pattern.vertices[pattern.edges].mean(axis=1)
    new = np.flatnonzero((pattern.edges >= WHOLE).any(axis=1) & (pattern.assignments != 0))
    creases = [e for e in new if pattern.assignments[e] in {Assignment.M, Assignment.V}]
    assert len(creases) == 6
    side = np.sign(middles[new[0], 0])
    for edge in creases:
        under = lying_under(fold, middles[edge] - side * np.array([200.0, 0.0]))
        assert pattern.assignments[edge] == pattern.assignments[under]
        assert pattern.fold_angles[edge] == pytest.approx(pattern.fold_angles[under], abs=1e-8)


def lying_under(fold: Fold, spot: np.ndarray) -> int:
    """Return the edge of the tube's own pattern that runs through a spot."""
    ends = fold.pattern.vertices[fold.pattern.edges]
    along = ends[:, 1] - ends[:, 0]
    share = np.einsum("ij,ij->i", spot - ends[:, 0], along) / (along**2).sum(axis=1)
    near = ends[:, 0] + np.clip(share, 0, 1)[:, None] * along
    gaps = np.hypot(*(near - spot).T)
    gaps[(fold.pattern.edges >= WHOLE).any(axis=1)] = np.inf
    assert gaps.min() < 1e-9
    return int(gaps.argmin())


@SHAPES
def test_the_seam_is_a_crease_as_in_every_other_wedge(name: str) -> None:
    fold = overlapped(name, 4.0)
    pattern = fold.pattern
    assert fold.folded is not None
    seam = fold.folded.seams[:, 1]
    inner = np.isin(pattern.edges, seam).all(axis=1)
    assert np.count_nonzero(inner) == 3
    for edge in np.flatnonzero(inner):
        height = pattern.vertices[pattern.edges[edge], 1]
        alike = (np.sort(pattern.vertices[pattern.edges, 1], axis=1) == np.sort(height)).all(axis=1)
        kinds = pattern.assignments[alike & (pattern.assignments != Assignment.B)]
        assert len(kinds) == 10
        assert set(kinds.tolist()) == {int(pattern.assignments[edge])}


@pytest.mark.parametrize("name", list(DESIGN.presets)[:7])
def test_on_the_way_nothing_stretches_and_the_overlap_leaves_the_facets_freely(name: str) -> None:
    fold = overlapped(name, 4.0)
    motion, pattern = fold.motions["along-arc"], fold.pattern
    assert np.array_equal(motion.at(0.0), space(fold))
    assert np.abs(motion.path(1e-14) - space(fold)).max() <= 1e-10
    for t in (0.01, 0.3, 0.7, 1.0):
        places = motion.at(t)
        ends = places[pattern.edges]
        change = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) - pattern.edge_lengths
        assert np.abs(change).max() <= 1e-12 * pattern.size
    assert not len(penetrations(motion.at(0.3), pattern.edges, pattern.faces))


@pytest.mark.parametrize("taper", [0, 25])
def test_the_ends_lean_by_the_taper(taper: float) -> None:
    fold = overlapped("vase", 4.0, taper)
    pattern = fold.pattern
    assert fold.folded is not None
    first, last = pattern.vertices[fold.folded.seams[[0, -1], 1], 1]
    edge = pattern.vertices[WHOLE:]
    rim = edge[np.isclose(np.abs(edge[:, 0]), np.abs(edge[:, 0]).max()), 1]
    lean = 4 * np.tan(np.radians(taper))
    assert rim.min() >= first + lean - 1e-9
    assert rim.max() == pytest.approx(last - lean)


def test_a_tube_with_an_overlap_can_be_planned_and_keeps_its_symmetry_to_itself() -> None:
    fold = overlapped("candlestick", 5.0)
    assert fold.symmetry is None
    assert (fold.meta["tabs"], fold.meta["overlap"]) == (0, 5.0)
    plan = make(fold, material(), machine(ONE_TOOL))
    assert {each.severity for each in plan.findings} <= {"info", "warning"}


@pytest.mark.parametrize(
    ("width", "taper", "said"),
    [
        (10, 0, r"An overlap 10 mm wide does not fit: it must be narrower than w = 10 mm"),
        (9, 75, r"does not fit at the seam that is 52\.5 mm long: with a taper of 75°"),
    ],
)
def test_an_overlap_without_room_is_refused_with_the_room_there_is(
    width: float, taper: float, said: str
) -> None:
    with pytest.raises(ImpossibleGeometry, match=said):
        overlapped("vase", width, taper)


def test_an_overlap_without_a_width_is_refused() -> None:
    with pytest.raises(InvalidParameters, match="holds nothing; make it wider"):
        overlapped("vase", 1e-9)


@pytest.mark.parametrize("block", range(2))
def test_a_random_tube_with_an_overlap_is_one_sheet_that_does_not_stretch(block: int) -> None:
    made = 0
    for seed in range(block * 60, (block + 1) * 60):
        params = random_design(seed)
        rng = np.random.default_rng(seed)
        wanted = {"tab": params.w * rng.uniform(0.1, 0.95), "taper": rng.uniform(0, 45)}
        try:
            fold = DESIGN.run(params.model_copy(update={**wanted, "seam": "overlap"}))
        except ImpossibleGeometry:
            continue
        findings = [found for rule in RULES for found in rule(fold).findings]
        assert not findings, (seed, findings)
        assert len(fold.pattern.outline()) == 1
        motion = fold.motions["along-arc"]
        ends = motion.at(motion.reach / 2)[fold.pattern.edges]
        change = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) - fold.pattern.edge_lengths
        assert np.abs(change).max() <= 1e-12 * fold.pattern.size
        made += 1
    assert made > 10
