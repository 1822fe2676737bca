"""Steps for the holder of a drag knife: none nearby would keep the tip nearer to its line."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from foldmill.kernels import SWITCH, is_compiling
from foldmill_fabricate.formats.hpgl import steps
from foldmill_fabricate.machines import Axes
from foldmill_fabricate.toolpath import tractrix
from foldmill_fabricate.toolpath.knife import holder_ways
from foldmill_fabricate.toolpath.snapping import Grid
from foldmill_fabricate.verify.blade import tips

Floats = NDArray[np.float64]

STEP = 0.025
AXES = {
    "plain": Axes(units_per_mm=40),
    "calibrated": Axes(units_per_mm=40, scale_x=1.004, scale_y=0.997, skew=0.3, swap=True),
    "coarse": Axes(units_per_mm=20),
}


def strays(holder: Floats, way: Floats, offset: float, heading: float) -> float:
    """Return how far the tip leaves the way, or misses its ends, mm."""
    (tip,) = tips([holder], offset, heading)
    far = float(shapely.distance(shapely.points(tip), shapely.LineString(way)).max())
    return max(far, *(float(np.hypot(*(tip[k] - way[k]))) for k in (0, -1)))


def bent(degrees: float, rng: np.random.Generator) -> Floats:
    angle = rng.uniform(0, 2 * np.pi)
    turn = angle + np.radians(degrees)
    first = rng.uniform(0, STEP, 2)
    second = first + 12 * np.array([np.cos(angle), np.sin(angle)])
    return np.array([first, second, second + 9 * np.array([np.cos(turn), np.sin(turn)])])


@pytest.mark.parametrize(("seed", "bend"), [(0, 14), (1, -14), (2, 14), (3, 25)])
def test_no_other_steps_around_would_keep_the_tip_nearer(seed: int, bend: float) -> None:
    """All ways of rounding every point up or down, tried one by one."""
    way, offset = bent(bend, np.random.default_rng(seed)), 0.25
    heading = float(np.arctan2(*(way[1] - way[0])[::-1]))
    (exact,) = holder_ways([way], offset, heading)
    (found,) = holder_ways([way], offset, heading, Grid(AXES["plain"]))
    low = np.floor(exact / STEP)
    assert 4 <= len(exact) <= 5
    least = min(
        strays((low + np.reshape(up, low.shape)) * STEP, way, offset, heading)
        for up in product((0.0, 1.0), repeat=low.size)
    )
    assert strays(found, way, offset, heading) <= max(1.25 * least, 0.6 * STEP)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("offset", [0.25, 0.9])
def test_steps_that_are_chosen_together_stray_little_more_than_half_a_diagonal(
    seed: int, offset: float
) -> None:
    rng = np.random.default_rng(seed)
    way, heading = bent(rng.uniform(-175, 175), rng), rng.uniform(0, 2 * np.pi)
    (found,) = holder_ways([way], offset, heading, Grid(AXES["plain"]))
    assert strays(found, way, offset, heading) <= 0.02


@pytest.mark.parametrize("name", AXES)
def test_a_machine_goes_to_the_places_that_are_chosen(name: str) -> None:
    axes, rng = AXES[name], np.random.default_rng(3)
    (found,) = holder_ways([bent(80.0, rng) + 50], 0.5, 1.0, Grid(axes))
    whole = steps(found, axes, "here")
    unit = steps(np.eye(2) * 1e6, axes.model_copy(update={"highest": 10**9}), "there").T / 1e6
    assert found == pytest.approx(np.linalg.solve(unit, whole.T).T, abs=2e-5)


def test_compiled_or_not_the_same_steps_are_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    import importlib

    rng = np.random.default_rng(8)
    ways = [bent(rng.uniform(-175, 175), rng) for _ in range(4)]
    compiled = holder_ways(ways, 0.25, 0.3, Grid(AXES["plain"]))
    try:
        monkeypatch.setenv(SWITCH, "1")
        importlib.reload(tractrix)
        plain = holder_ways(ways, 0.25, 0.3, Grid(AXES["plain"]))
        assert not is_compiling()
    finally:
        monkeypatch.delenv(SWITCH)
        importlib.reload(tractrix)
    for one, other in zip(compiled, plain, strict=True):
        assert (one == other).all()
