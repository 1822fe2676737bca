"""A sheet over pages of paper: nothing is lost between them, and they can be laid together."""

from __future__ import annotations

from pathlib import Path

import hand_made
import numpy as np
import poppler
import pytest
import stools
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill_fabricate.formats import pdf
from foldmill_fabricate.formats.tiles import ARM, OVERLAP, PAPERS, Paper, crosses, tiling

SIDES = st.floats(20, 3000)
PAPER = st.sampled_from(sorted(PAPERS))


@given(SIDES, SIDES, PAPER)
def test_every_spot_of_the_sheet_is_on_a_tile_and_neighbours_overlap(
    width: float, height: float, paper: Paper
) -> None:
    laid = tiling(width, height, paper)
    wide, high = laid.window
    for starts, side, length in ((laid.xs, wide, width), (laid.ys[::-1], high, height)):
        assert starts[0] <= 1e-9
        assert starts[-1] + side >= length - 1e-9
        assert np.diff(starts) + OVERLAP == pytest.approx([side] * (len(starts) - 1))
        assert len(starts) == 1 or starts[-1] < length  # none is empty


@settings(max_examples=30)
@given(SIDES, SIDES, PAPER)
def test_every_cross_is_whole_on_the_two_tiles_it_joins(
    width: float, height: float, paper: Paper
) -> None:
    laid = tiling(width, height, paper)
    wide, high = laid.window
    for x, y in crosses(laid):
        whole = [
            tile.name
            for tile in laid.tiles
            if tile.x + ARM < x < tile.x + wide - ARM and tile.y + ARM < y < tile.y + high - ARM
        ]
        assert len(whole) == 2
    pairs = len(laid.xs) * (len(laid.ys) - 1) + len(laid.ys) * (len(laid.xs) - 1)
    assert len(list(crosses(laid))) == 2 * pairs


def test_tiles_are_named_like_the_squares_of_a_chessboard_from_above() -> None:
    laid = tiling(500, 500, "a4")
    assert [tile.name for tile in laid.tiles] == ["A1", "B1", "C1", "A2", "B2", "C2"]
    assert laid.neighbour(laid.tiles[1], 1, 0) == "C1"
    assert laid.neighbour(laid.tiles[1], 0, 1) == "B2"
    assert laid.neighbour(laid.tiles[1], 0, -1) == ""
    assert len(tiling(500, 500, "a3").tiles) == 4
    assert tiling(9900, 100, "a4").tiles[26].name == "AA1"


@pytest.mark.parametrize("paper", sorted(PAPERS))
def test_the_stools_tiles_laid_together_are_the_stool(paper: Paper, tmp_path: Path) -> None:
    plan = stools.stool_plan()
    files = pdf.TILED[paper](plan, stools.stool())
    content = files[f"front-{paper}.pdf"]
    laid = tiling(500, 500, paper)
    sizes = poppler.page_sizes(content, tmp_path)
    assert len(sizes) == len(laid.tiles) + 1
    whole = poppler.lines(pdf.write(plan, stools.stool())["front.pdf"], tmp_path)
    assert len(whole) > 70
    shown = np.zeros(len(whole), bool)
    for page, tile in enumerate(laid.tiles, start=2):
        assert sizes[page - 1] == pytest.approx(laid.page, abs=0.025)
        drawn = [line for _, line in poppler.lines(content, tmp_path, page)]
        low = np.array([tile.x, tile.y])
        for k, (_, line) in enumerate(whole):
            on_page = line - low + (8.0, 20.0)
            is_here = any(len(o) == len(line) and np.abs(o - on_page).max() < 0.025 for o in drawn)
            inside = (line > low) & (line < low + laid.window)
            assert is_here or not inside.all(axis=1).any()
            shown[k] |= is_here
    assert shown.all()


def test_each_tile_carries_its_name_its_neighbours_and_100_mm(tmp_path: Path) -> None:
    content = pdf.TILED["a4"](stools.stool_plan(), stools.stool())["reverse-a4.pdf"]
    words = poppler.pages(content, tmp_path)
    assert "6 pages" in words[0]
    for page, tile in enumerate(tiling(500, 500, "a4").tiles, start=2):
        said = words[page - 1]
        assert tile.name in said.split()
        assert "100 mm" in said
        level = [
            line
            for _, line in poppler.lines(content, tmp_path, page)
            if len(line) == 2 and line[0, 1] == pytest.approx(line[1, 1]) and line[0, 1] < 20
        ]
        assert max(np.ptp(line[:, 0]) for line in level) == pytest.approx(100, abs=0.005)


def test_a_small_sheet_takes_one_tile(tmp_path: Path) -> None:
    content = pdf.TILED["a4"](hand_made.plan(), hand_made.fold())["master-a4.pdf"]
    assert len(poppler.page_sizes(content, tmp_path)) == 2
