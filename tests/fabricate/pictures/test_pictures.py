"""Pictures, read back as pixels and lines; what they show is judged by geometry, not by bytes."""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
from collections import Counter
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import hand_made
import numpy as np
import pytest
from PIL import Image

from foldmill import CreasePattern, Fold, FoldedForm, InvalidInput
from foldmill_fabricate.pictures import (
    folded_picture,
    pattern_picture,
    pattern_svg,
    sheet_picture,
    show_picture,
)
from foldmill_fabricate.pictures.canvas import round_length
from foldmill_fabricate.pictures.render import INK, INSIDE, OUTSIDE, Camera, render
from foldmill_plugins.tuck import DESIGN

if TYPE_CHECKING:
    from conftest import Golden
    from numpy.typing import NDArray

STOOL = DESIGN.run(DESIGN.preset("stool-n8"))
STRIP = hand_made.fold()
FROM_ABOVE = Camera(azimuth=-68, elevation=89.9)
FROM_BELOW = Camera(azimuth=-68, elevation=-89.9)


def pixels(png: bytes) -> NDArray[np.uint8]:
    return np.asarray(Image.open(BytesIO(png)).convert("RGB"))


def count(image: NDArray[np.uint8], colour: str) -> int:
    wanted = [int(colour[k : k + 2], 16) for k in (1, 3, 5)]
    return int((image == wanted).all(axis=2).sum())


def tinted(image: NDArray[np.float64], colour: tuple[float, float, float]) -> NDArray[np.bool_]:
    """Tell which pixels show a colour, however the light falls on it."""
    length = np.linalg.norm(image, axis=2, keepdims=True)
    along = (image / length) @ (np.array(colour) / np.linalg.norm(colour))
    return np.asarray(along > 0.9999)


def square(height: float, edges: str = "BBBB") -> Fold:
    flat = np.array([[0, 0], [10, 0], [10, 10], [0, 10]], float)
    pattern = CreasePattern.from_lines(flat, [(0, 1), (1, 2), (2, 3), (3, 0)], edges)
    return Fold(pattern, FoldedForm(np.column_stack([flat, np.full(4, height)])))


def test_a_pattern_shows_its_mountains_red_and_its_valleys_blue() -> None:
    image = pixels(pattern_picture(STOOL))
    red, blue, black = (count(image, c) for c in ("#d62020", "#1f4fd8", "#000000"))
    assert red > blue > 1000
    assert black > 1000


def test_pictures_are_the_same_every_time_and_say_nothing_of_when() -> None:
    code = (
        "import hashlib, sys, hand_made as h\n"
        "from foldmill_fabricate import pictures as p\n"
        "strip = h.fold()\n"
        "drawn = [p.show_picture(strip), p.sheet_picture(h.plan()), p.folded_picture(strip)]\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
        "print(hashlib.sha256(b''.join(drawn)).hexdigest())"
    )
    drawn = [show_picture(STRIP), sheet_picture(hand_made.plan()), folded_picture(STRIP)]
    for png in drawn:
        assert not {"Software", "Creation Time"} & set(Image.open(BytesIO(png)).info)
    command = [sys.executable, "-W", "ignore", "-c", code]
    folder = str(Path(hand_made.__file__).parent)
    environment = {**os.environ, "PYTHONPATH": folder, "PYTHONHASHSEED": "7"}
    said = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert said.stdout.strip() == hashlib.sha256(b"".join(drawn)).hexdigest()


def test_drawing_leaves_everybodys_settings_alone() -> None:
    import matplotlib as mpl

    with mpl.rc_context({"lines.linewidth": 9.0, "font.size": 30.0}):
        strange = show_picture(STRIP)
        assert mpl.rcParams["lines.linewidth"] == 9.0
    assert strange == show_picture(STRIP)


def test_from_above_the_stool_is_a_flat_octagonal_seat_and_nothing_of_its_inside() -> None:
    image = render(STOOL, FROM_ABOVE, 400)
    seen = (image < 0.999).any(axis=2)
    across = 0.96 * 400  # the drawn form fills this much of the picture
    octagon = 2 * np.tan(np.pi / 8) * across**2
    assert seen.sum() > 0.8 * octagon
    assert tinted(image, OUTSIDE).sum() > 0.9 * seen.sum()
    assert not tinted(image, INSIDE).any()
    # The seat is flat: one colour over most of the picture.
    shades = Counter(map(tuple, np.round(image[seen], 3).tolist()))
    assert shades.most_common(1)[0][1] > 0.6 * seen.sum()


def test_from_below_the_stool_shows_its_inside_in_the_other_colour() -> None:
    image = render(STOOL, FROM_BELOW, 400)
    assert tinted(image, INSIDE).sum() > 10_000
    assert tinted(image, OUTSIDE).sum() > 10_000


def test_the_stool_looks_the_same_after_an_eighth_of_a_turn() -> None:
    one, two = (render(STOOL, Camera(azimuth=20 + turn, elevation=30), 300) for turn in (0, 45))
    assert (np.abs(one - two).max(axis=2) > 0.1).mean() < 0.005


@pytest.mark.parametrize("order", [1, -1])
def test_what_is_nearer_hides_what_is_farther_whatever_the_order(order: int) -> None:
    # Two triangles one above the other; from above only the upper one is seen, its front up.
    flat = np.array([[0, 0], [10, 0], [5, 8], [20, 0], [30, 0], [25, 8]], float)
    faces = np.array([[0, 1, 2], [3, 4, 5]])[::order]
    edges = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)]
    pattern = CreasePattern(flat, np.array(edges), np.zeros(6, np.uint8), np.zeros(6), faces)
    upper = [(0, 0, 5), (10, 0, 5), (5, 8, 5)]
    lower = [(8, 1, 0), (2, 1, 0), (5, 6, 0)]  # the other way round: its reverse is up
    stacked = Fold(pattern, FoldedForm(np.array(upper + lower, float)))
    assert not tinted(render(stacked, Camera(-90, 89), 200), INSIDE).any()
    assert tinted(render(stacked, Camera(-90, -89), 200), OUTSIDE).any()


@pytest.mark.parametrize(("sign", "colour"), [(-1, OUTSIDE), (1, INSIDE)])
def test_of_facets_folded_onto_each_other_the_right_one_is_on_top(
    sign: int, colour: tuple[float, float, float]
) -> None:
    flat = np.array([[0, 0], [10, 0], [20, 0], [20, 10], [10, 10], [0, 10]], float)
    edges = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)]
    letter, angles = "V" if sign > 0 else "M", [0.0] * 6 + [180.0 * sign]
    pattern = CreasePattern.from_lines(flat, edges, "B" * 6 + letter, angles)
    x = np.where(flat[:, 0] > 10, 20 - flat[:, 0], flat[:, 0])  # the right half lies on the left
    closed = Fold(pattern, FoldedForm(np.column_stack([x, flat[:, 1], np.zeros(6)])))
    # The fixed half has its front up: a valley lays the other half on it, reverse side up.
    image = render(closed, Camera(-90, 89.9), 200)
    seen = (image < 0.999).any(axis=2)
    assert tinted(image, colour).sum() > 0.9 * seen.sum()


def test_edges_that_fold_are_inked_and_flat_ones_are_not() -> None:
    image = render(square(0), Camera(-90, 89.9), 200)
    inked = np.abs(image - np.array(INK)).max(axis=2) < 0.05
    middle = inked[40:160, 40:160]
    assert inked.any()
    assert not middle.any()  # the square's added diagonal


def test_without_a_folded_form_one_is_told_so() -> None:
    flat_only = Fold(STRIP.pattern)
    with pytest.raises(InvalidInput, match="Only the crease pattern is known"):
        folded_picture(flat_only)
    assert show_picture(flat_only).startswith(b"\x89PNG")


def test_a_sheet_shows_both_faces_apart_and_names_what_is_on_it() -> None:
    image = pixels(sheet_picture(hand_made.plan()))
    for colour in ("#0050d0", "#f07800", "#d01010", "#109030", "#8000a0", "#a09000"):
        assert count(image, colour) > 50, colour


@pytest.mark.parametrize(("about", "length"), [(106, 100), (100, 100), (49, 20), (0.3, 0.2)])
def test_scale_bars_are_round(about: float, length: float) -> None:
    assert round_length(about) == pytest.approx(length)


def test_the_pattern_svg_is_in_origami_simulators_colours(golden: Golden) -> None:
    golden.check("hand-made/pattern.svg", pattern_svg(STRIP))
    text = pattern_svg(STOOL).decode()
    colours = Counter(re.findall(r"stroke:(#[0-9a-f]{6})", text))
    assert colours == {"#ff0000": 80, "#0000ff": 56, "#ffff00": 24, "#000000": 16}
    root = ElementTree.fromstring(text)
    assert root.attrib["width"] == "540.4mm"
    assert root.attrib["viewBox"] == "0 0 540.4 540.4"
    assert "transform" not in text


def test_the_pattern_svg_carries_the_fold_angles_as_opacity() -> None:
    text = pattern_svg(STOOL).decode()
    for colour, sign in (("#ff0000", -1), ("#0000ff", 1)):
        read = re.findall(rf"stroke:{colour};stroke-width:0.5;stroke-opacity:([\d.]+)", text)
        angles = STOOL.pattern.fold_angles
        expected = np.sort(np.abs(angles[angles * sign > 0]))
        assert np.sort([180 * float(each) for each in read]) == pytest.approx(expected, abs=0.01)
