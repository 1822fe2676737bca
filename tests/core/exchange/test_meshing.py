"""Sheets of many slits and holes are read whole: each face has one rim, and no cut is moved."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from foldmill import Fold
from foldmill.exchange.assembling import fold_of
from foldmill.exchange.drawing import Look, drawing_of
from foldmill.exchange.options import Options
from foldmill.planar import signed_areas

Rows = list[tuple[float, float, float, float]]
BOX: Rows = [(0, 0, 100, 0), (100, 0, 100, 100), (100, 100, 0, 100), (0, 100, 0, 0)]
ELL: Rows = [
    *((0, 0, 100, 0), (100, 0, 100, 40), (100, 40, 40, 40)),
    *((40, 40, 40, 100), (40, 100, 0, 100), (0, 100, 0, 0)),
]


def sheet(drawn: Rows, letters: str) -> Fold:
    looks = [Look(letter) for letter in letters]
    return fold_of(drawing_of(drawn, looks, down=False, millimetres=1.0), Options())


def lines(fold: Fold, letter: str) -> int:
    return fold.pattern.letters().count(letter)


def slits(n: int, stagger: float, tilt: float) -> Rows:
    """n × n slits of 0.6 of their spacing, rows moved by a share of it, all turned by deg."""
    step, turn = 100 / n, math.radians(tilt)
    c, s = 0.3 * step * math.cos(turn), 0.3 * step * math.sin(turn)
    spots = [
        ((i + 0.4 + stagger * (j % 2) / 5) * step, (j + 0.5) * step)
        for j in range(n)
        for i in range(n)
    ]
    return [(x - c, y - s, x + c, y + s) for x, y in spots]


def holes(n: int, corners: int = 8) -> Rows:
    """n × n polygonal holes."""
    step = 100 / n
    turn = 2 * math.pi * np.arange(corners + 1) / corners
    rim = 0.3 * step * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    found: Rows = []
    for x in range(n):
        for y in range(n):
            places = rim + np.array([x + 0.5, y + 0.5]) * step
            found += [(*a, *b) for a, b in pairwise(places.tolist())]
    return found


def covers(fold: Fold, area: float) -> bool:
    """Tell whether the facets are as much paper as the sheet has, none turned over."""
    areas = signed_areas(fold.pattern.vertices, fold.pattern.faces.tolist())
    return bool((areas > 0).all()) and math.isclose(areas.sum(), area, rel_tol=1e-9)


@pytest.mark.parametrize(("stagger", "tilt"), [(0, 0), (1, 0), (1, 30), (0, 90), (1, 63.7)])
@pytest.mark.parametrize("n", [12, 24])
def test_hundreds_of_slits_are_kept_as_they_are_drawn(n: int, stagger: float, tilt: float) -> None:
    drawn = slits(n, stagger, tilt)
    fold = sheet([*BOX, *drawn], "BBBB" + "C" * len(drawn))
    assert lines(fold, "C") == len(drawn)
    assert lines(fold, "B") == 4
    assert covers(fold, 1e4)
    cut = fold.pattern.vertices[fold.pattern.edges[np.array(list(fold.pattern.letters())) == "C"]]
    wanted = {tuple(sorted(((a, b), (c, d)))) for a, b, c, d in np.round(drawn, 6).tolist()}
    assert {tuple(sorted(map(tuple, each))) for each in cut.round(6).tolist()} == wanted


def test_hundreds_of_holes_are_kept() -> None:
    drawn = holes(16)
    fold = sheet([*BOX, *drawn, (0, 50, 100, 50)], "BBBB" + "C" * len(drawn) + "M")
    assert (lines(fold, "C"), lines(fold, "M")) == (len(drawn), 1)
    assert covers(fold, 1e4)


def test_slits_in_a_sheet_with_a_corner_inward_add_no_paper() -> None:
    drawn = [row for row in slits(24, 1, 0) if max(row[0], row[2]) < 39 or row[1] < 39]
    fold = sheet([*ELL, *drawn], "BBBBBB" + "C" * len(drawn))
    assert lines(fold, "C") == len(drawn)
    assert covers(fold, 6400)


def test_a_few_slits_are_still_tied_by_few_lines() -> None:
    fold = sheet([*BOX, *slits(2, 0, 0)], "BBBBCCCC")
    ties = next(each.message for each in fold.findings if each.code == "import-tied")
    assert int(ties.split()[0]) <= 8
    assert covers(fold, 1e4)
