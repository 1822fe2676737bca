"""Waterbomb tessellations: their graphs, exact units, search, distance, flat pattern, failures."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from waterbomb_targets import HELICOID, NARROW, PLAIN

from foldmill import Assignment, Fold, ImpossibleGeometry
from foldmill.check import check
from foldmill.check.developability import angle_sums
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.base import Offsets, base_mesh, closed_topology
from foldmill_plugins.waterbomb.build import E_TOTAL, Build
from foldmill_plugins.waterbomb.closeness import mesh_distances, target_samples
from foldmill_plugins.waterbomb.curvature import flat_metric
from foldmill_plugins.waterbomb.distance import Target
from foldmill_plugins.waterbomb.jacobian import Stars
from foldmill_plugins.waterbomb.metric import flat_period, slide_of
from foldmill_plugins.waterbomb.params import TableSurface, WaterbombParams
from foldmill_plugins.waterbomb.solve import develop
from foldmill_plugins.waterbomb.surfaces import TABLE, Jet, Surface
from foldmill_plugins.waterbomb.topology import Topology

THESIS = {
    "catenoid-8x6": 3.29e-2,
    "catenoid-10x7": 2.95e-2,
    "catenoid-13x9": 2.41e-2,
    "catenoid-20x14": 1.61e-2,
    "catenoid": 2.60e-2,
    "sphere": 1.44e-2,
    "cylinder": 1.59e-2,
    "vase": 1.59e-2,
    "torus": 8.97e-3,
    "hyperbolic-paraboloid": 1.35e-2,
    "moebius": 1.40e-2,
}
ROWS = pytest.mark.parametrize("name", list(THESIS))
SURFACES = pytest.mark.parametrize("name", list(TABLE))


def made(**values: Any) -> Fold:
    return DESIGN.run(values)


def on(kind: str, n_u: int, n_v: int, **values: Any) -> WaterbombParams:
    return DESIGN.validate({"surface": {"kind": kind}, "n_u": n_u, "n_v": n_v, **values})


def euler(topology: Topology) -> int:
    return len(topology.k) - len(topology.edges) + len(topology.faces)


@pytest.mark.parametrize(("n_u", "n_v"), list(itertools.product((2, 3, 5, 8), (1, 2, 3, 6))))
def test_a_graph_has_the_counts_its_sizes_ask_for(n_u: int, n_v: int) -> None:
    both, odd = n_u * n_v, n_v // 2
    around, flat = Topology(n_u, n_v, True), Topology(n_u, n_v)
    v_around, v_flat = (n_v + 1) * 2 * n_u + both, (n_v + 1) * (2 * n_u + 1) + both + odd
    closed = 4 * n_u
    open_ = 4 * n_u + 2 * (n_v - odd + 2 * odd)
    _counts(around, v_around, v_around + 6 * both, (n_v - 1) * 2 * n_u + both, closed, 0)
    inner = (n_v - 1) * (2 * n_u - 1) + both - odd
    _counts(flat, v_flat, v_flat + 6 * both - 1, inner, open_, 1)
    assert np.count_nonzero(around.assignments == Assignment.M) == 5 * both - 2 * n_u
    if n_v % 2 == 0:
        torus = Topology(n_u, n_v, True, True)
        _counts(torus, 3 * both, 9 * both, 3 * both, 0, 0)
        assert np.count_nonzero(torus.assignments == Assignment.M) == 5 * both


def _counts(graph: Topology, v: int, e: int, inner: int, border: int, chi: int) -> None:
    assert (len(graph.k), len(graph.edges)) == (v, e)
    assert len(graph.faces) == 6 * graph.n_u * graph.n_v
    assert np.count_nonzero(graph.is_interior) == inner
    assert np.count_nonzero(graph.assignments == Assignment.B) == border
    assert np.count_nonzero(graph.assignments == Assignment.V) == 4 * graph.n_u * graph.n_v
    assert euler(graph) == chi


@pytest.mark.parametrize("closes", [(False, False), (True, False), (True, True)])
def test_mountains_and_valleys_differ_by_two_round_every_inner_vertex(
    closes: tuple[bool, bool],
) -> None:
    graph = Topology(5, 4, *closes)
    counts = np.zeros((2, len(graph.k)), int)
    for row, kind in enumerate((Assignment.M, Assignment.V)):
        ends = graph.edges[graph.assignments == kind].ravel()
        counts[row] = np.bincount(ends, minlength=len(graph.k))
    inner = graph.is_interior
    assert (np.abs(counts[0] - counts[1])[inner] == 2).all()
    assert (counts[1][inner & graph.is_centre] == 4).all()


@pytest.mark.parametrize("closes", [(False, False), (True, False), (True, True)])
def test_neighbours_go_once_round_their_vertex(closes: tuple[bool, bool]) -> None:
    graph = Topology(4, 4, *closes)
    triangles = {tuple(np.roll(f, -f.argmin())) for f in graph.faces}
    for centre, star in zip(*graph.stars, strict=True):
        assert len(set(star)) == 6
        for a, b in itertools.pairwise([*star, star[0]]):
            face = np.array([centre, a, b])
            assert tuple(np.roll(face, -face.argmin())) in triangles


@pytest.mark.parametrize(("n_u", "n_v"), [(3, 1), (4, 2), (5, 4), (6, 3)])
def test_the_cut_graph_glued_again_is_the_closed_one(n_u: int, n_v: int) -> None:
    for graph in (Topology(n_u, n_v, True), Topology(n_u, n_v, True, n_v % 2 == 0)):
        glued = {tuple(sorted(face)) for face in graph.origin[graph.opened().faces].tolist()}
        assert glued == {tuple(sorted(face)) for face in graph.faces.tolist()}


@SURFACES
def test_derivatives_of_the_targets_are_those_of_their_points(name: str) -> None:
    surface, step = TABLE[name], 1e-5
    rng = np.random.default_rng(1)
    u, v = (rng.uniform(*span, 40) for span in (surface.u, surface.v))
    jet = surface.jet(u, v)

    def slope(what: str, du: float, dv: float) -> np.ndarray:
        one, two = surface.jet(u + du, v + dv), surface.jet(u - du, v - dv)
        difference: np.ndarray = (getattr(one, what) - getattr(two, what)) / (2 * step)
        return difference

    for found, wanted in (
        (jet.u, slope("p", step, 0)),
        (jet.v, slope("p", 0, step)),
        (jet.uu, slope("u", step, 0)),
        (jet.uv, slope("u", 0, step)),
        (jet.vv, slope("v", 0, step)),
    ):
        assert np.abs(found - wanted).max() < 1e-8


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.5, 0.8])
def test_an_exact_unit_is_developable_and_unfolds_to_its_period(ratio: float) -> None:
    w, h = 1.7, 1.1
    c, s = ratio * h, float(slide_of(ratio)) * h
    assert c * c == pytest.approx((h / 2 + s) * (3 * s - h / 2), abs=1e-14)
    flat = Surface(
        "plane",
        lambda u, v: _plane(u, v),
        (0.0, 4 * w),
        (0.0, 6 * h),
    )
    graph = Topology(4, 6)
    points = base_mesh(flat, graph, Offsets(c / np.sqrt(w * h), s / h, is_rim_inside=False))
    sums = angle_sums(points, graph.faces)[graph.is_interior]
    assert np.abs(sums - 2 * np.pi).max() < 1e-12
    width, height = flat_period(w, h, c)
    area = np.linalg.norm(_doubled(points, graph), axis=1).sum() / 2
    assert area == pytest.approx(24 * width * height, rel=1e-12)  # rims slide to and fro alike


def _doubled(points: np.ndarray, graph: Topology) -> np.ndarray:
    a, b, c = points[graph.faces].transpose(1, 0, 2)
    return np.cross(b - a, c - a)


def _plane(u: np.ndarray, v: np.ndarray) -> Jet:
    o = np.zeros_like(u)
    flat = np.column_stack([o, o, o])
    along, across = np.column_stack([o + 1, o, o]), np.column_stack([o, o + 1, o])
    return Jet(np.column_stack([u, v, o]), along, across, flat, flat, flat)


@pytest.mark.parametrize("is_free", [True, False])
def test_the_jacobian_is_the_slope_of_the_angle_sums(is_free: bool) -> None:
    build = Build(on("torus", 5, 4, boundary="free" if is_free else "fixed"))
    for params in (build.params, on("hyperbolic-paraboloid", 3, 3, boundary="fixed")):
        stars, points = Build(params).stars, Build(params).base
        residual, jacobian = stars.linearised(points)
        inner = angle_sums(points, Build(params).topology.faces)[stars.centre]
        assert np.abs(residual - (inner - 2 * np.pi)).max() < 1e-12
        step = 1e-6 * np.random.default_rng(2).normal(size=jacobian.shape[1])
        change = stars.residual(stars.moved(points, step)) - stars.residual(
            stars.moved(points, -step)
        )
        assert np.abs(change / 2 - jacobian @ step).max() < 1e-9 * np.abs(step).max()


@ROWS
def test_every_row_of_the_tables_is_developable_close_and_flat(name: str) -> None:
    fold = DESIGN.run(DESIGN.presets[name])
    report, facts = check(fold), fold.meta
    assert facts["status"]["verdicts"] == ["ok"]
    assert facts["convergence"]["iterations"] <= 10
    assert facts["convergence"]["e_total_deg"][-1] <= E_TOTAL
    assert facts["distance"]["mean"] <= THESIS[name]
    assert not report.has_errors
    assert report.figures["penetrations"] == 0
    pattern, form = fold.pattern, fold.folded
    assert form is not None
    ends = form.vertices[pattern.edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert np.abs(pattern.edge_lengths / lengths - 1).max() < 1e-9
    bases = DESIGN.presets[name].n_u * DESIGN.presets[name].n_v
    assert pattern.count(Assignment.V) == 4 * bases
    assert np.ptp(pattern.vertices, axis=0).max() == pytest.approx(400)


@ROWS
def test_the_thesis_own_problem_is_solved_as_near_to_the_target(name: str) -> None:
    build = Build(DESIGN.presets[name].model_copy(update=PLAIN))
    found, target = build.developed, Target.of(build.surface)
    assert found.is_converged
    assert found.iterations <= 10
    d = target.distances(found.points).mean() / target.diagonal
    assert d <= 1.2 * THESIS[name]
    fixed = ~build.topology.is_interior
    assert np.array_equal(found.points[fixed], build.base[fixed])


def test_the_search_moves_the_mesh_no_more_than_it_must() -> None:
    build = Build(on("catenoid", 6, 4, start="uniform"))
    residual, jacobian = build.stars.linearised(build.base)
    one = develop(build.stars, build.base, 0.0, 1).points
    least = np.linalg.lstsq(jacobian.toarray(), -residual, rcond=None)[0]
    assert np.abs(one - build.stars.moved(build.base, least)).max() < 1e-9


@pytest.mark.parametrize("boundary", ["free", "fixed"])
@pytest.mark.parametrize("kind", ["torus", "vase"])
def test_one_sector_gives_the_whole_search(kind: str, boundary: str) -> None:
    build = Build(on(kind, 12, 6, boundary=boundary))
    assert np.abs(build._by_sector().points - build.developed.points).max() < 1e-9


def test_a_coarse_search_begins_a_fine_one_nearer_to_its_end() -> None:
    build = Build(on("hyperbolic-paraboloid", 30, 30, start="uniform"))
    begun = develop(build.stars, build._begun_by_a_coarser(), E_TOTAL, 40)
    plain = develop(build.stars, build.base, E_TOTAL, 40)
    assert begun.is_converged
    assert begun.errors[1] < plain.errors[1] / 2


@pytest.mark.parametrize("kind", ["sphere", "vase", "moebius"])
def test_the_flat_metric_takes_the_curvature_away(kind: str) -> None:
    surface = TABLE[kind]
    topology = closed_topology(surface, 20, 4 if kind == "moebius" else 10)
    start = flat_metric(surface, topology, 0.3)
    assert start.is_feasible
    assert start.left < 0.01


def test_a_peak_too_steep_is_said_to_be_unlikely_and_is_not_called_developable() -> None:
    peak = Surface("peak", _peak, (-1.0, 1.0), (-1.0, 1.0))
    topology = closed_topology(peak, 12, 12)
    start = flat_metric(peak, topology, 0.3)
    assert not start.is_feasible
    offsets = Offsets(start.depth, start.slide)
    stars = Stars.of(topology, is_boundary_free=False)
    found = develop(stars, base_mesh(peak, topology, offsets), E_TOTAL, 25)
    assert not found.is_converged


def _peak(u: np.ndarray, v: np.ndarray) -> Jet:
    z = 1.2 * np.exp(-6 * (u * u + v * v))
    o = np.zeros_like(z)
    zu, zv = -12 * u * z, -12 * v * z
    zuu, zuv, zvv = (144 * u * u - 12) * z, 144 * u * v * z, (144 * v * v - 12) * z
    return Jet(
        np.column_stack([u, v, z]),
        np.column_stack([o + 1, o, zu]),
        np.column_stack([o, o + 1, zv]),
        np.column_stack([o, o, zuu]),
        np.column_stack([o, o, zuv]),
        np.column_stack([o, o, zvv]),
    )


def test_distances_are_those_known_by_heart() -> None:
    rng = np.random.default_rng(3)
    points = rng.uniform(-4, 4, (300, 3))
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    torus = Target.of(TABLE["torus"])
    assert torus.distances(points) == pytest.approx(np.abs(np.hypot(r - 3, z) - 1), abs=1e-12)
    cylinder = Target.of(TABLE["cylinder"])
    beyond = np.maximum(np.abs(z) - np.pi, 0)
    assert cylinder.distances(points) == pytest.approx(np.hypot(r - 1, beyond), abs=1e-12)
    assert torus.diagonal == pytest.approx(np.sqrt(8**2 * 2 + 2**2), rel=1e-9)
    assert Target.of(TABLE["vase"]).diagonal == pytest.approx(11.0, rel=1e-9)


@pytest.mark.parametrize("name", ["catenoid", "hyperbolic-paraboloid", "moebius"])
def test_no_dense_sample_of_a_target_is_nearer_than_the_projection(name: str) -> None:
    surface = TABLE[name]
    points = Build(DESIGN.presets[name]).base[::7]
    target = Target.of(surface)
    exact, dense = target.distances(points), Target.of(surface, 600, 400)
    sampled = np.array([np.linalg.norm(dense.samples - p, axis=1).min() for p in points])
    assert (exact <= sampled + 1e-12).all()
    assert (sampled - exact).max() < 0.02


@pytest.mark.parametrize("side", ["inner", "outer"])
@pytest.mark.parametrize("kind", ["catenoid", "torus", "vase"])
def test_pits_are_seen_as_valleys_from_the_front_whichever_side_they_are_on(
    kind: str, side: str
) -> None:
    n_u, n_v = {"catenoid": (12, 8), "torus": (36, 8), "vase": (20, 10)}[kind]
    fold = DESIGN.run(on(kind, n_u, n_v, side=side, start="uniform"))
    assert fold.folded is not None
    solid, faces = fold.folded.vertices, fold.pattern.faces
    a, b, c = solid[faces].transpose(1, 0, 2)
    normal, middle = np.cross(b - a, c - a), (a + b + c) / 3
    if kind == "torus":
        ring = middle[:, :2] / np.linalg.norm(middle[:, :2], axis=1, keepdims=True)
        size = np.linalg.norm(solid[:, :2], axis=1)
        middle = middle - np.column_stack([ring * (size.max() + size.min()) / 2, 0 * middle[:, 2]])
        outwards = np.einsum("ij,ij->i", middle, normal).sum()
    else:
        outwards = np.einsum("ij,ij->i", middle[:, :2], normal[:, :2]).sum()
    assert outwards > 0 if side == "inner" else outwards < 0
    assert fold.meta["status"]["wrong_signed"] <= 0.1 * len(fold.pattern.edges)


def test_seam_vertices_meet_in_space_and_a_torus_has_both_seams() -> None:
    fold = DESIGN.run(on("torus", 12, 6))
    assert fold.folded is not None
    ends = fold.folded.vertices[fold.folded.seams]
    assert np.array_equal(ends[:, 0], ends[:, 1])
    distinct = len(np.unique(np.round(fold.folded.vertices, 6), axis=0))
    assert distinct == 3 * 12 * 6
    assert len(fold.pattern.vertices) - len(fold.folded.seams) == distinct


def test_a_torus_with_an_odd_number_of_strips_stays_open_along_v() -> None:
    fold = DESIGN.run(on("torus", 55, 9))
    assert fold.meta["status"]["verdicts"] == ["ok"]
    assert fold.folded is not None
    assert len(fold.folded.seams) == 10 + 4


def test_facets_through_each_other_are_told_though_all_else_is_well() -> None:
    fold = DESIGN.run(NARROW)
    assert fold.meta["status"]["verdicts"] == ["self-intersecting"]
    codes = [finding.code for finding in check(fold).findings]
    assert codes == ["penetration", "feasibility"]


def test_a_form_without_fault_whose_sheet_lies_upon_itself_is_told_as_such() -> None:
    fold = DESIGN.run({**HELICOID, **PLAIN})
    assert fold.meta["status"]["verdicts"] == ["flat-overlap"]
    report = check(fold)
    assert {finding.code for finding in report.findings} == {
        *("edges-cross", "outline", "flat-overlap")
    }
    assert report.figures["penetrations"] == 0


def test_creases_that_fold_the_other_way_are_told_as_such() -> None:
    fold = DESIGN.run(on("torus", 55, 10, depth=0.2))
    assert fold.meta["status"]["verdicts"] == ["wrong-signed"]
    (finding,) = [each for each in check(fold).findings if each.code == "crease-sign"]
    wrong = fold.meta["status"]["wrong_signed"]
    assert finding.message.startswith(f"{wrong} of ")


def test_a_search_that_fails_is_refused_with_the_reason_and_what_to_do() -> None:
    with pytest.raises(ImpossibleGeometry, match="No developable form was found") as refusal:
        DESIGN.run(on("sphere", 21, 12, start="uniform", slide=0.02, boundary="fixed"))
    assert "free boundary" in str(refusal.value)


def test_one_base_round_a_closed_target_is_refused() -> None:
    with pytest.raises(ImpossibleGeometry, match="at least 2 bases"):
        DESIGN.run(on("catenoid", 1, 4))
    assert len(DESIGN.run(on("cylinder", 2, 3, depth=0.5)).pattern.faces) == 36


def test_poles_lines_gaps_and_holes_of_a_target_are_refused_with_their_place() -> None:
    sphere = TABLE["sphere"]
    half = np.pi / 2
    pole = Surface("ball", sphere.jet, sphere.u, (-half, half), True)
    line = Surface("line", _line, (0.0, 1.0), (0.0, 1.0))
    hole = Surface("hole", lambda u, v: _plane(u, np.log(v)), (0.0, 1.0), (0.0, 1.0))
    gap = Surface("gap", lambda u, v: _plane(u, v), (0.0, 1.0), (0.0, 1.0), True)
    graph = Topology(4, 4, True)
    offsets = Offsets(0.5, 0.0)
    with pytest.raises(ImpossibleGeometry, match=r"At u = .*ball (has no normal|gives a facet)"):
        base_mesh(pole, graph, offsets)
    with pytest.raises(ImpossibleGeometry, match=r"line (has no normal|gives a facet)"):
        base_mesh(line, Topology(4, 4), offsets)
    with np.errstate(all="ignore"), pytest.raises(ImpossibleGeometry, match="no finite point"):
        base_mesh(hole, Topology(4, 4), offsets)
    with pytest.raises(ImpossibleGeometry, match="does not close along u"):
        closed_topology(gap, 4, 4)


def _line(u: np.ndarray, v: np.ndarray) -> Jet:
    flat = _plane(u + v, 0 * v)
    return replace(flat, v=flat.u)


def test_the_user_is_told_before_solving_whether_it_is_likely_to_work() -> None:
    good = DESIGN.report("feasibility", DESIGN.presets["sphere"])
    bad = DESIGN.report("feasibility", on("catenoid", 8, 12))
    assert good["is_likely"]
    assert good["advice"] == "none"
    assert not bad["is_likely"]
    assert "times as deep" in str(bad["advice"])


@pytest.mark.parametrize(("sized", "axis"), [("width", 0), ("height", 1)])
def test_the_sheet_is_as_large_as_asked_for(sized: str, axis: int) -> None:
    fold = made(sized=sized, size=250.0)
    assert np.ptp(fold.pattern.vertices, axis=0)[axis] == pytest.approx(250)
    unit = made(sized="unit", size=50.0)
    assert unit.meta["mm_per_unit"] == 50


def test_every_measure_of_closeness_is_told_and_agrees_with_a_slow_one() -> None:
    params = DESIGN.presets["catenoid-8x6"]
    told = DESIGN.report("closeness", params)
    build = Build(params)
    points, faces = build.developed.points, build.topology.faces
    places = target_samples(Target.of(build.surface), 8)[0]
    exact = mesh_distances(places, points[faces])
    share = np.linspace(0, 1, 40)
    a, b = (grid.ravel() for grid in np.meshgrid(share, share))
    inside = np.column_stack([a, b, 1 - a - b])[a + b <= 1]
    cloud = np.einsum("sk,fkc->fsc", inside, points[faces]).reshape(-1, 3)
    slow = np.array([np.linalg.norm(cloud - place, axis=1).min() for place in places])
    assert (exact <= slow + 1e-12).all()
    assert (slow - exact).max() < 0.03
    assert told["vertices_mean"] == DESIGN.run(params).meta["distance"]["mean"]
    assert 0 < told["facets_mean"] < told["vertices_largest"]
    assert told["reverse_mean"] < told["reverse_largest"]
    assert 1 < told["edge_ratio"] < 10


def test_convergence_is_told_step_by_step_and_squares_its_error() -> None:
    told = DESIGN.report("convergence", DESIGN.presets["sphere"])
    errors = told["e_total_deg"]
    assert len(errors) == told["iterations"] + 1
    assert all(b < a for a, b in itertools.pairwise(errors))
    assert errors[3] < 10 * (errors[2] / 30) ** 2 * 30
    assert max(told["e_max_deg"][-1], told["e_min_deg"][-1]) == pytest.approx(errors[-1], abs=1e-12)


def test_the_surface_is_told_by_its_kind() -> None:
    assert TableSurface(kind="vase").surface() is TABLE["vase"]
