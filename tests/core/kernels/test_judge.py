"""Three forms of the kernels, compiled, uncompiled and over columns, judge strips alike."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from foldmill import InvalidInput
from foldmill.check.intersection import penetrations
from foldmill.kernels import (
    CODES,
    SWITCH,
    Limits,
    Strips,
    Verdicts,
    columns,
    is_compiling,
    judge,
    judging,
)
from foldmill.kernels import jit as shim
from foldmill.kernels import strips as ready
from foldmill.kernels.judging import judge_with
from foldmill.kernels.tables import wheels

Floats = NDArray[np.float64]
NEEDS_NUMBA = pytest.mark.skipif(not is_compiling(), reason="numba is not installed")


@pytest.fixture
def plain(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The kernels as plain Python: loaded anew with compiling switched off."""
    monkeypatch.setenv(SWITCH, "1")
    spec = importlib.util.spec_from_file_location("plain_strips", str(ready.__file__))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def tubes(count: int, seed: int, *, is_mixed: bool = True) -> Strips:
    """Return strips between parallel lines, 7 points, of all outcomes."""
    rng = np.random.default_rng(seed)
    n, w = rng.integers(3, 13, count if is_mixed else 1), 10.0
    steps = rng.uniform(4, 25, (count if is_mixed else 1, 7))
    y = np.zeros_like(steps)
    for k in range(1, 7):
        y[:, k] = steps[:, k] if k == 1 else y[:, k - 2] + steps[:, k]
    edge, theta = np.hypot(w, y[:, 1]), np.pi / n
    r = rng.uniform(0, 0.9, count) ** 2 * edge / np.sin(theta)
    beta = rng.uniform(0, 2 * np.pi, count)
    radius = np.sqrt(edge**2 - (r * np.sin(theta)) ** 2)
    second = r * np.cos(theta) + radius * np.sin(beta)
    size = np.maximum(y.max(axis=1), w)[:, None]
    rises = y[:, 2:] - y[:, :-2], y[:, 1:-1] - y[:, :-2]
    return Strips(
        n.astype(np.int64),
        np.column_stack([r, 0 * r, second, radius * np.cos(beta)]),
        np.stack(np.broadcast_arrays(*rises, w, size), axis=2),
        rng.choice([-1.0, 1.0], (count if is_mixed else 1, 5)),
        is_first_on_l2=False,
    )


def assert_alike(one: Verdicts, two: Verdicts) -> None:
    assert np.array_equal(one.codes, two.codes)
    assert np.array_equal(one.at, two.at)
    assert np.allclose(one.extents, two.extents, rtol=0, atol=1e-9, equal_nan=True)


@pytest.mark.parametrize("is_mixed", [True, False])
def test_compiled_uncompiled_and_over_columns_are_one(plain: ModuleType, is_mixed: bool) -> None:
    strips = tubes(1500, 3, is_mixed=is_mixed)
    loop = judge_with(plain.judge, strips, Limits())
    assert {0, 2, 3} <= set(loop.codes.tolist())
    assert_alike(loop, judge_with(columns.judge, strips, Limits()))
    assert_alike(loop, judge_with(ready.judge, strips, Limits()))


@NEEDS_NUMBA
def test_compiled_and_over_columns_are_one_on_many_blocks_of_rows() -> None:
    strips = tubes(3 * columns.BLOCK + 7, 4)
    found = judge_with(ready.judge, strips, Limits())
    assert np.bincount(found.codes, minlength=4)[:4].min() > 20
    assert_alike(found, judge_with(columns.judge, strips, Limits()))


@pytest.fixture(params=[0, judging.COMPILED_FROM])
def both(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Judge few strips compiled, and then over columns."""
    monkeypatch.setattr(judging, "COMPILED_FROM", request.param)


def test_without_numba_the_columns_are_used(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(judging, "COMPILED_FROM", 0)
    strips = tubes(50, 5)
    usual = judge(strips)
    monkeypatch.setenv(SWITCH, "1")
    assert not is_compiling()
    assert_alike(usual, judge(strips))


@pytest.mark.usefixtures("both")
def test_the_mirror_image_of_a_strip_meets_the_same_end() -> None:
    strips = tubes(4000, 6)
    image = Strips(
        strips.order,
        strips.start * np.array([1, -1, 1, -1]),
        strips.paper,
        -strips.branches,
        is_first_on_l2=False,
    )
    assert_alike(judge(strips), judge(image))


@pytest.mark.usefixtures("both")
def test_a_strip_shifted_along_the_axis_meets_the_same_end() -> None:
    strips = tubes(4000, 7)
    shifted = strips.start + np.array([0, 37.5, 0, 37.5])
    image = Strips(strips.order, shifted, strips.paper, strips.branches, is_first_on_l2=False)
    assert_alike(judge(strips), judge(image))


@pytest.mark.usefixtures("both")
def test_some_of_the_strips_are_judged_as_among_all() -> None:
    strips = tubes(300, 8)
    some = np.array([5, 250, 17, 17])
    whole, part = judge(strips), judge(strips.take(some))
    assert np.array_equal(whole.codes[some], part.codes)
    assert np.array_equal(whole.extents[some], part.extents, equal_nan=True)


def grid_strips(count: int, seed: int) -> Floats:
    """Return strips (count, 7, 2) of r and z on a small grid: many touch, lie upon each other, or
    meet exactly along a crease."""
    rng = np.random.default_rng(seed)
    found: list[Floats] = []
    while len(found) < count:
        spots = rng.integers([1, -1], [3, 2], (7, 2)).astype(float)
        if (spots[2:] != spots[:-2]).any(axis=1).all():
            found.append(spots)
    return np.array(found)


def in_space(spots: Floats, spin: Floats) -> Floats:
    """Return points (7, 3) with the two planes at ±Θ/2."""
    sign = np.where(np.arange(len(spots)) % 2 == 1, 1.0, -1.0)
    r, z = spots.T
    return np.column_stack([r * spin[2], r * spin[3] * sign, z])


def by_loop(module: Any, spots: Floats, spin: Floats, size: float) -> tuple[bool, bool]:
    """Return whether triangles cross, and whether the strip slides through along a crease."""
    room = np.zeros((4, 7))
    room[0], room[1] = spots.T
    normals, heights = np.zeros((5, 4)), np.zeros((5, 7))
    code = module.verdict(room, spin, Limits().as_row(), size, normals, heights)
    eps = Limits().penetration * size
    crosses = bool(module.crosses(room, normals, heights, eps))
    slides = bool(module.slides(room, normals, heights, eps))
    assert (code == CODES.PENETRATES) == (crosses or slides)
    return crosses, slides


def test_where_facets_touch_or_meet_along_a_crease_the_kernels_say_what_the_check_says() -> None:
    spin = wheels(np.array([6]), is_first_on_l2=False)[0]
    faces = np.array([(k, k + 1, k + 2) if k % 2 else (k, k + 2, k + 1) for k in range(5)])
    edges = np.array([(i, j) for i in range(7) for j in (i + 1, i + 2) if j < 7])
    every, verdicts, only_sliding = grid_strips(800, 9), [], 0
    sizes = np.array([np.ptp(in_space(spots, spin), axis=0).max() for spots in every])
    for spots, size in zip(every, sizes, strict=True):
        crosses, slides = by_loop(ready, spots, spin, size)
        truth = penetrations(in_space(spots, spin), edges, faces)
        assert bool(len(truth)) == (crosses or slides), spots
        verdicts.append(crosses or slides)
        only_sliding += slides and not crosses
    assert 50 < sum(verdicts) < len(verdicts) - 50
    assert only_sliding > 3
    spins, moved = spin[None], np.moveaxis(every, 2, 0)
    codes = columns._verdicts(moved, spins, Limits().as_row(), sizes)
    assert np.array_equal(codes == CODES.PENETRATES, verdicts)


@pytest.mark.usefixtures("both")
def test_two_circles_that_are_one_are_reported_and_not_guessed() -> None:
    # Point 2 stands square over point 0: c = 0, and the foot of point 1 on Π1 is point 0 itself.
    theta = np.pi / 6
    paper = np.array([[[20.0, 0.0, 5.0, 30.0], [20.0, 10.0, 5.0, 30.0]]])
    start = np.array([[10 * np.cos(theta), 0.0, 10.0, 0.0]])
    strips = Strips(np.array([6]), start, paper, np.ones((1, 2)), is_first_on_l2=False)
    found = judge(strips)
    assert (found.codes[0], found.at[0]) == (CODES.TURNS_FREELY, 2)
    assert np.isnan(found.extents).all()


def test_arrays_that_do_not_belong_together_are_refused() -> None:
    strips = tubes(5, 10)
    with pytest.raises(InvalidInput, match=r"branches has the shape \(3, 5\)"):
        Strips(strips.order, strips.start, strips.paper, strips.branches[:3], is_first_on_l2=False)


@NEEDS_NUMBA
def test_few_that_are_left_of_many_configurations_are_judged_as_the_many(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    used: list[str] = []
    monkeypatch.setattr(judging, "judge_with", lambda loop, *_: used.append(loop.__module__))
    strips = tubes(20, 11)
    judge(strips)
    judge(strips, among=judging.COMPILED_FROM)
    assert [each.rpartition(".")[2] for each in used] == ["columns", "strips"]


def test_few_configurations_are_judged_without_numba() -> None:
    code = """if True:
        import sys
        import numpy as np
        from foldmill.configurations import outcomes
        from foldmill_plugins.six_crease import DESIGN
        found = outcomes(DESIGN, DESIGN.preset("vase"), {"beta": np.linspace(0, 359, 2000)})
        sys.exit("numba" in sys.modules or len(set(found.codes.tolist())) < 3)
    """
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@NEEDS_NUMBA
def test_where_nothing_can_be_kept_a_function_is_compiled_all_the_same() -> None:
    space: dict[str, Any] = {}
    exec(compile("def double(x):\n    return 2 * x\n", "nowhere", "exec"), space)
    assert shim.jit(space["double"])(21) == 42


def test_the_kernels_stand_in_one_file_so_that_an_old_compilation_is_noticed() -> None:
    source = Path(str(ready.__file__)).read_text("utf-8")
    imported = [line for line in source.splitlines() if line.startswith("from foldmill")]
    assert imported == ["from foldmill.kernels.jit import jit"]
