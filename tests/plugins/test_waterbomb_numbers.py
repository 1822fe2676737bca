"""The linear systems and the flat layout behind waterbomb tessellations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csc_matrix, random_array

from foldmill_plugins.waterbomb import linear, unfold
from foldmill_plugins.waterbomb.build import Build
from foldmill_plugins.waterbomb.presets import PRESETS
from foldmill_plugins.waterbomb.simple import is_simple, outline
from foldmill_plugins.waterbomb.topology import Topology


def system(seed: int, rows: int = 120) -> csc_matrix:
    """A symmetric positive matrix whose pattern differs from seed to seed."""
    part = random_array((rows, rows), density=0.03, rng=np.random.default_rng(seed))
    return csc_matrix(part @ part.T + 3 * np.eye(rows))


@pytest.mark.parametrize("has_library", [True, False])
def test_systems_of_like_and_unlike_pattern_are_solved_in_a_row(
    has_library: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not has_library:
        monkeypatch.setattr(linear, "_qdldl", lambda: None)
    solver, right = linear.Factorised(), np.arange(120.0)
    first, second = system(1), system(2)
    for matrix in (first, first * 2, second, first):
        found = solver.solve(matrix, 0.5, right)
        assert found is not None
        assert np.abs(matrix @ found + 0.5 * found - right).max() < 1e-9


def test_kept_factors_solve_a_like_system(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linear, "_qdldl", lambda: None)
    monkeypatch.setattr(linear, "MANY", 0)
    made: list[object] = []
    superlu = linear._superlu

    def counted(matrix: object) -> object:
        made.append(matrix)
        return superlu(matrix)

    monkeypatch.setattr(linear, "_superlu", counted)
    solver, right, matrix = linear.Factorised(), 1e-3 * np.arange(120.0), system(3)
    near = matrix.copy()
    near.data = near.data * (1 + 0.01 * np.cos(np.arange(near.nnz)))
    near = csc_matrix((near + near.T) / 2)
    for each in (matrix, near):
        found = solver.solve(each, 0.0, right)
        assert found is not None
        assert np.linalg.norm(each @ found - right) < 2e-3 * np.linalg.norm(right)
    assert len(made) == 1


@pytest.mark.parametrize("name", ["torus", "hyperbolic-paraboloid"])
def test_a_search_ends_in_the_same_form_with_either_solver(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("qdldl")
    monkeypatch.setattr(linear, "MANY", 0)
    forms = []
    for most in (0, 30_000):
        monkeypatch.setattr(linear, "MOST_QDLDL", most)
        found = Build(PRESETS[name]).developed
        assert found.is_converged
        forms.append(found.points)
    assert np.abs(forms[0] - forms[1]).max() < 1e-6 * np.ptp(forms[0])


@pytest.mark.parametrize("name", ["torus", "moebius", "vase"])
def test_all_lengths_are_kept_whether_factors_or_rounds_refine_them(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    build = Build(PRESETS[name])
    cut = build.topology.opened()
    solid = build.developed.points[build.topology.origin]
    one = unfold.unfold(cut, solid)
    monkeypatch.setattr(unfold, "MANY", 0)
    two = unfold.unfold(cut, solid)
    wanted = np.linalg.norm(np.diff(solid[cut.edges], axis=1)[:, 0], axis=1)
    for flat in (one, two):
        lengths = np.linalg.norm(np.diff(flat[cut.edges], axis=1)[:, 0], axis=1)
        assert np.abs(lengths / wanted - 1).max() < 1e-11
    assert np.abs(one - two).max() < 1e-8 * np.ptp(one)


def test_noise_of_the_search_is_taken_out_of_the_lengths() -> None:
    build = Build(PRESETS["catenoid"])
    cut = build.topology.opened()
    solid = build.developed.points[build.topology.origin]
    flat = unfold.unfold(cut, solid)
    noisy = flat + 1e-4 * np.random.default_rng(4).normal(size=flat.shape)
    again = unfold.refined(cut.edges, solid, noisy)
    lengths = np.linalg.norm(np.diff(again[cut.edges], axis=1)[:, 0], axis=1)
    wanted = np.linalg.norm(np.diff(solid[cut.edges], axis=1)[:, 0], axis=1)
    assert np.abs(lengths / wanted - 1).max() < 1e-10


def test_an_outline_that_meets_itself_is_seen() -> None:
    build = Build(PRESETS["catenoid-8x6"])
    cut = build.topology.opened()
    flat = unfold.unfold(cut, build.developed.points[build.topology.origin])
    assert len(outline(cut)) == len(set(outline(cut).tolist())) == 4 * 8 + 2 * (3 + 6)
    assert is_simple(cut, flat)
    width = np.ptp(flat[:, 0])
    angle = 2.2 * np.pi * flat[:, 0] / width
    bent = (flat[:, 1] + 2 * width)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    assert not is_simple(cut, bent)


def test_the_outline_of_a_graph_is_one_loop_of_boundary_edges() -> None:
    for n_u, n_v in ((2, 1), (3, 2), (5, 5)):
        graph = Topology(n_u, n_v)
        loop = outline(graph)
        sides = np.sort(np.column_stack([loop, np.roll(loop, -1)]), axis=1)
        border = graph.edges[graph.assignments == 0]
        assert {tuple(s) for s in sides.tolist()} == {tuple(s) for s in border.tolist()}
