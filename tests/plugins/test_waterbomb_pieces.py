"""Forms in pieces: whole together, each flat, glue tabs that lie upon their neighbours, notches."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely
from stools import ONE_TOOL, machine, material
from waterbomb_targets import HELICOID as STAIRS
from waterbomb_targets import NARROW

from foldmill import Assignment, Fold, ImpossibleGeometry, InvalidParameters
from foldmill.check import check
from foldmill.finding import Severity
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import verify
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.piece_params import Pieces
from foldmill_plugins.waterbomb.pieces import Made, Whole, divided, made, piece
from foldmill_plugins.waterbomb.topology import Topology

HELICOID = {**STAIRS, "size": 800.0}
SADDLE = {"surface": {"kind": "hyperbolic-paraboloid"}, "n_u": 6, "n_v": 5}
TUBE = {"surface": {"kind": "catenoid"}, "n_u": 8, "n_v": 5}
TORUS = {"surface": {"kind": "torus"}, "n_u": 40, "n_v": 10, "size": 1600.0}
CUTS = pytest.mark.parametrize(
    ("form", "columns", "rows"), [(SADDLE, 2, 3), (TUBE, 1, 2), (TUBE, 3, 2), (TORUS, 2, 1)]
)


def all_of(form: dict[str, Any], columns: int, rows: int, **more: Any) -> list[Fold]:
    asked = {"columns": columns, "rows": rows, **more}
    return [
        DESIGN.run({**form, "pieces": {**asked, "piece": n}}) for n in range(1, columns * rows + 1)
    ]


def errors(fold: Fold) -> list[str]:
    return [str(each) for each in check(fold).findings if each.severity is Severity.ERROR]


def solid(fold: Fold) -> np.ndarray:
    assert fold.folded is not None
    return np.asarray(fold.folded.vertices)


def area(fold: Fold) -> float:
    corners = fold.pattern.vertices[fold.pattern.faces]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return float((one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]).sum() / 2)


def outline(fold: Fold) -> Any:
    edges = fold.pattern.vertices[fold.pattern.edges[fold.pattern.assignments == Assignment.B]]
    (polygon,) = shapely.polygonize(list(shapely.linestrings(edges))).geoms
    return polygon


@CUTS
def test_bare_pieces_are_the_whole_form_cut_apart(
    form: dict[str, Any], columns: int, rows: int
) -> None:
    whole, parts = DESIGN.run(form), all_of(form, columns, rows, notch=0)
    assert sum(len(part.pattern.faces) for part in parts) == len(whole.pattern.faces)
    assert sum(map(area, parts)) == pytest.approx(area(whole))
    middles = [solid(part)[part.pattern.faces].mean(axis=1) for part in parts]
    wanted = solid(whole)[whole.pattern.faces].mean(axis=1)
    assert np.sort(np.vstack(middles), axis=0) == pytest.approx(np.sort(wanted, axis=0))
    for part in parts:
        assert errors(part) == []
        assert part.meta["status"]["verdicts"] == ["ok"]
        kinds = part.pattern.assignments
        assert part.pattern.count(Assignment.V) == np.count_nonzero(kinds == Assignment.V) > 0


@CUTS
def test_seams_meet_in_space_whatever_side_one_looks_from(
    form: dict[str, Any], columns: int, rows: int
) -> None:
    parts = all_of(form, columns, rows, notch=0)
    told: dict[tuple[int, int, int], list[dict[str, Any]]] = {}
    for part in parts:
        own, numbers = part.meta["pieces"]["piece"], []
        for seam in part.meta["pieces"]["seams"]:
            ends = sorted((own, seam["meets"]))
            told.setdefault((ends[0], ends[1], seam["seam"]), []).append(seam)
            numbers.append(seam["seam"])
        assert len(set(numbers)) == len(numbers)
    for (one, two, _), sides in told.items():
        if one != two:
            assert {each["tabs"] for each in sides} == {"here", "there"}
    borders = []
    for part in parts:
        edges = part.pattern.edges[part.pattern.assignments == Assignment.B]
        borders += [solid(part)[edges].mean(axis=1)]
    middles = np.vstack(borders)
    gaps = np.linalg.norm(middles[:, None] - middles, axis=2)
    meeting = int(np.count_nonzero(gaps < 1e-9) - len(middles)) // 2
    assert meeting == sum(sides[0]["edges"] for sides in told.values())


@CUTS
def test_a_glue_tab_lies_upon_a_facet_of_the_piece_across_the_seam(
    form: dict[str, Any], columns: int, rows: int
) -> None:
    width = 3.0
    bare, tabbed = (all_of(form, columns, rows, notch=0, tabs=t) for t in (0, width))
    facets = np.vstack([solid(part)[part.pattern.faces] for part in bare])
    assert sum(map(area, tabbed)) > sum(map(area, bare))
    for before, after in zip(bare, tabbed, strict=True):
        assert errors(after) == []
        known = solid(before)
        new = [p for p in solid(after) if np.linalg.norm(known - p, axis=1).min() > 1e-6]
        here = [s["edges"] for s in after.meta["pieces"]["seams"] if s["tabs"] == "here"]
        assert len(new) == 2 * sum(here)
        for spot in new:
            assert _nearest(spot, facets) < 1e-9


def _nearest(spot: np.ndarray, facets: np.ndarray) -> float:
    """Return how far a place is from the nearest triangle that it lies over."""
    a, one, two = facets[:, 0], facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0]
    normal = np.cross(one, two)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    height = ((spot - a) * normal).sum(axis=1)
    local = np.stack([one, two, normal], axis=2)
    share = np.linalg.solve(local, (spot - a)[:, :, None])[:, :, 0]
    inside = (share[:, :2].min(axis=1) > -1e-9) & (share[:, :2].sum(axis=1) < 1 + 1e-9)
    return float(np.abs(height[inside]).min())


def notch_tips(fold: Fold) -> np.ndarray:
    """Return where in space the outline has its narrowest re-entrant corners."""
    ring = np.asarray(outline(fold).exterior.normalize().coords)[:-1]
    if not shapely.is_ccw(shapely.linearrings(ring)):
        ring = ring[::-1]
    ahead, behind = np.roll(ring, -1, axis=0) - ring, ring - np.roll(ring, 1, axis=0)
    cross = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
    turn = np.degrees(np.arctan2(cross, (behind * ahead).sum(axis=1)))
    short = np.abs(np.hypot(*ahead.T) - np.hypot(*behind.T)) < 1e-6
    tips = ring[(turn < -100) & short & (np.hypot(*ahead.T) < 2)]
    index = [np.linalg.norm(fold.pattern.vertices - tip, axis=1).argmin() for tip in tips]
    return solid(fold)[index]


@pytest.mark.parametrize(("form", "columns", "rows"), [(SADDLE, 2, 3), (TORUS, 2, 1)])
def test_notches_of_a_seam_are_as_many_as_its_number_and_face_each_other(
    form: dict[str, Any], columns: int, rows: int
) -> None:
    parts = all_of(form, columns, rows, tabs=3)
    tips = np.vstack([notch_tips(part) for part in parts])
    assert len(tips) > 0
    for part in parts:
        assert errors(part) == []
        own = notch_tips(part)
        wanted = sum(
            s["seam"] * (1 + (s["meets"] == part.meta["pieces"]["piece"]))
            for s in part.meta["pieces"]["seams"]
        )
        assert len(own) == wanted
    gaps = np.linalg.norm(tips[:, None] - tips, axis=2) + 1e9 * np.eye(len(tips))
    assert gaps.min(axis=1).max() < 2 * 0.8 * 2 + 1e-9  # two tips over one edge, each 1.6 mm deep


def test_a_sheet_that_lies_upon_itself_becomes_pieces_that_do_not() -> None:
    whole = DESIGN.run(HELICOID)
    assert whole.meta["status"]["verdicts"] == ["flat-overlap"]
    assert any("Cut it into pieces by --pieces.auto true" in each for each in errors(whole))
    for part in all_of(HELICOID, 2, 1, tabs=4):
        assert errors(part) == []
        assert part.meta["status"]["verdicts"] == ["ok"]
        assert outline(part).is_valid
        assert outline(part).area == pytest.approx(area(part))


def test_a_sheet_that_lies_upon_itself_is_cut_by_itself_into_as_few_pieces_as_it_takes() -> None:
    fold, graph = DESIGN.run(HELICOID), Topology(60, 6)
    found = divided(Whole(fold, graph, graph.origin), Pieces(auto=True, tabs=4))
    assert found.count > 1
    for count in range(1, found.count):
        for columns in [n for n in range(1, count + 1) if count % n == 0 and count // n <= 6]:
            fewer = made(
                Whole(fold, graph, graph.origin), Pieces(notch=0), columns, count // columns
            )
            assert not all(map(fewer.is_simple, range(count)))
    for n in range(1, found.count + 1):
        part = DESIGN.run({**HELICOID, "pieces": {"auto": True, "tabs": 4, "piece": n}})
        assert errors(part) == []
        assert part.meta["designed"]["verdict"] == "ok"
        assert part.meta["designed"]["piece"] == f"{n} of {found.count}"
        assert outline(part).is_valid


def test_more_pieces_than_it_takes_are_kept_where_they_are_asked_for() -> None:
    wanted = {"auto": True, "columns": 3, "rows": 2}
    assert DESIGN.run({**HELICOID, "pieces": wanted}).meta["pieces"]["of"] == 6


@pytest.mark.parametrize("form", [SADDLE, TUBE])
def test_a_sheet_that_does_not_lie_upon_itself_is_left_as_it_is(form: dict[str, Any]) -> None:
    plain, auto = DESIGN.run(form), DESIGN.run({**form, "pieces": {"auto": True}})
    assert np.array_equal(plain.pattern.vertices, auto.pattern.vertices)
    assert {k: v for k, v in plain.meta.items() if k != "design"} == {
        k: v for k, v in auto.meta.items() if k != "design"
    }


def test_what_is_wrong_with_the_whole_is_told_of_each_piece() -> None:
    for part in all_of(NARROW, 2, 1, notch=0):
        assert "self-intersecting" in part.meta["status"]["verdicts"]
        assert any("Put together, the form passes through itself" in each for each in errors(part))


def sizes(found: Made) -> np.ndarray:
    """Return the smaller and the larger side of every piece's box, mm."""
    boxes = [np.ptp(piece(found, n).pattern.vertices, axis=0) for n in range(1, found.count + 1)]
    return np.sort(boxes, axis=1)


def test_as_many_sheets_are_taken_as_are_needed_and_no_more() -> None:
    form = {**SADDLE, "size": 700.0}
    fold, graph = DESIGN.run(form), Topology(6, 5)
    whole = Whole(fold, graph, graph.origin)
    wanted = Pieces(sheet_width=300.0, sheet_height=200.0, tabs=5)
    found = divided(whole, wanted)
    assert (sizes(found) <= np.array([200, 300]) + 1e-6).all()
    assert found.count >= area(fold) / (300 * 200)
    for columns in range(1, 7):
        for rows in range(1, 6):
            if columns * rows < found.count:
                fewer = made(whole, Pieces(tabs=5, notch=0), columns, rows)
                assert (sizes(fewer) > [200, 300]).any()
    meta = DESIGN.run({**form, "pieces": wanted.model_dump()}).meta["pieces"]
    assert (meta["of"], meta["piece"]) == (found.count, 1)


def test_a_tube_in_one_piece_gets_tabs_along_its_seam() -> None:
    fold = DESIGN.run({**TUBE, "pieces": {"tabs": 4}})
    plain = DESIGN.run(TUBE)
    assert errors(fold) == []
    assert fold.meta["title"] == plain.meta["title"]
    assert fold.folded is not None
    assert plain.folded is not None
    assert len(fold.folded.seams) == len(plain.folded.seams)
    a, b = fold.folded.seams.T
    assert solid(fold)[a] == pytest.approx(solid(fold)[b])
    assert len(fold.pattern.faces) == len(plain.pattern.faces) + 2 * (len(a) - 1)


@pytest.mark.parametrize(
    ("pieces", "said"),
    [
        ({"columns": 7}, "6 × 5 bases cannot be cut into 7 × 1"),
        ({"rows": 6}, "6 × 5 bases cannot be cut into 1 × 6"),
        ({"columns": 2, "piece": 3}, "there are 2 pieces, so none has the number 3"),
        ({"columns": 2, "tabs": 50}, "Make the tabs narrower"),
        ({"columns": 2, "notch": 50}, "Seam 1 has .* room for 0 matching notches 50 mm wide"),
        ({"sheet_width": 20, "sheet_height": 20}, "Even single bases do not fit"),
        ({"sheet_width": 300}, "both sheet_width and sheet_height"),
        ({"tabs": -1}, "pieces.tabs must be at least 0 mm"),
        ({"columns": 0}, "pieces.columns must be"),
    ],
)
def test_pieces_that_cannot_be_are_refused_in_a_sentence(pieces: dict[str, Any], said: str) -> None:
    with pytest.raises((ImpossibleGeometry, InvalidParameters), match=said):
        DESIGN.run({**SADDLE, "pieces": pieces})


def test_one_sheet_without_tabs_is_the_design_as_it_was() -> None:
    assert Pieces().is_whole(is_simple=True)
    assert Pieces().is_whole(is_simple=False)
    assert "pieces" not in DESIGN.run(SADDLE).meta


def test_a_piece_goes_through_plan_and_verify() -> None:
    fold = DESIGN.run(
        {**SADDLE, "size": 500.0, "pieces": {"columns": 2, "rows": 2, "tabs": 6, "piece": 3}}
    )
    plan = make(fold, material(), machine(ONE_TOOL))
    assert verify(plan, fold.pattern, hpgl.write(plan, fold)).ok
