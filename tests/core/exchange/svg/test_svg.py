"""What an SVG shows is what is read: places through all transforms, looks through all styles."""

from __future__ import annotations

import random
from math import cos, pi, radians, sin

import numpy as np
import pytest

from foldmill import UnreadableFile
from foldmill.exchange import svg
from foldmill.exchange.drawing import Drawing
from foldmill.exchange.svg import curves

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="x" {}>{}</svg>'
PAGE = 'width="100mm" height="50mm" viewBox="0 0 100 50"'


def drawn(body: str, page: str = "") -> Drawing:
    return svg.read(HEAD.format(page, body).encode())


def points(body: str, page: str = "") -> list[list[float]]:
    drawing = drawn(body, page)
    return [*drawing.segments[:, 0].tolist(), drawing.segments[-1, 1].tolist()]


LINE = '<path d="M0 0L10 0" stroke="red"/>'


@pytest.mark.parametrize(
    ("transform", "wanted"),
    [
        ("translate(3)", [[3, 0], [13, 0]]),
        ("translate(3,-4)", [[3, -4], [13, -4]]),
        ("scale(2)", [[0, 0], [20, 0]]),
        ("scale(-1 2)", [[0, 0], [-10, 0]]),
        ("rotate(90)", [[0, 0], [0, 10]]),
        ("rotate(90 10 0)", [[10, -10], [10, 0]]),
        ("skewY(45)", [[0, 0], [10, 10]]),
        ("matrix(0 1 1 0 5 6)", [[5, 6], [5, 16]]),
        ("translate(1 1) scale(2)", [[1, 1], [21, 1]]),
        ("scale(2),translate(1 1)", [[2, 2], [22, 2]]),
    ],
)
def test_transforms_move_a_line(transform: str, wanted: list[list[float]]) -> None:
    found = points(f'<g transform="{transform}">{LINE}</g>')
    assert np.allclose(found, wanted, atol=1e-12)


def test_groups_within_groups_move_from_the_inside_out() -> None:
    chance = random.Random(5)
    names = (
        "translate({} {})",
        "rotate({})",
        "scale({} {})",
        "skewX({})",
        "matrix({} {} {} {} 1 2)",
    )
    for _ in range(20):
        chosen = [chance.choice(names) for _ in range(4)]
        calls = [
            name.format(*(round(chance.uniform(-3, 3), 3) for _ in range(name.count("{}"))))
            for name in chosen
        ]
        nested = LINE
        for call in reversed(calls):
            nested = f'<g transform="{call}">{nested}</g>'
        together = f'<g transform="{" ".join(calls)}">{LINE}</g>'
        assert np.allclose(points(nested), points(together), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("page", "mm", "width"),
    [
        (PAGE, True, 10.0),
        ('width="4in" height="4in" viewBox="0 0 100 100"', True, 10.16),
        ('width="200mm" height="50mm" viewBox="0 0 100 50"', True, 10.0),  # the smaller scale
        (
            'width="200mm" height="50mm" viewBox="0 0 100 50" preserveAspectRatio="none"',
            True,
            20.0,
        ),
        ('width="100mm" height="100mm"', True, 10 * 25.4 / 96),
        ('width="200" height="100" viewBox="0 0 100 50"', False, 20.0),
        ('width="100%" viewBox="0 0 100 50"', False, 10.0),
        ("", False, 10.0),
    ],
)
def test_a_page_in_mm_says_how_large_it_is_and_one_in_px_does_not(
    page: str, mm: bool, width: float
) -> None:
    drawing = drawn(LINE, page)
    assert (drawing.millimetres is not None) == mm
    assert np.ptp(drawing.segments[..., 0]) * (drawing.millimetres or 1) == pytest.approx(width)


@pytest.mark.parametrize(
    ("shape", "wanted"),
    [
        ('<line x1="1" y1="2" x2="3" y2="4" {}/>', [[1, 2], [3, 4]]),
        ('<line x2="1in" {}/>', [[0, 0], [96, 0]]),
        ('<polyline points="0,0 5,0,5 5" {}/>', [[0, 0], [5, 0], [5, 5]]),
        ('<polygon points="0 0 5 0 5 5" {}/>', [[0, 0], [5, 0], [5, 5], [0, 0]]),
        (
            '<rect x="1" y="2" width="3" height="4" {}/>',
            [[1, 2], [4, 2], [4, 6], [1, 6], [1, 2]],
        ),
        ('<path d="m1 1 2 0 0 2z" {}/>', [[1, 1], [3, 1], [3, 3], [1, 1]]),
        ('<path d="M1,1H5V7h-1v-1" {}/>', [[1, 1], [5, 1], [5, 7], [4, 7], [4, 6]]),
        ('<path d="M.5.5-1-1e0" {}/>', [[0.5, 0.5], [-1, -1]]),
    ],
)
def test_shapes_are_their_sides(shape: str, wanted: list[list[float]]) -> None:
    assert points(shape.format('stroke="red"')) == wanted


def test_a_second_part_of_a_path_does_not_hang_on_the_first() -> None:
    drawing = drawn('<path d="M0 0h9zM5 5v1m3 3l1 1" stroke="red"/>')
    assert drawing.segments.tolist() == [
        [[0, 0], [9, 0]],
        [[9, 0], [0, 0]],
        [[5, 5], [5, 6]],
        [[8, 9], [9, 10]],
    ]


@pytest.mark.parametrize(
    ("shape", "radius"),
    [
        ('<circle cx="0" cy="0" r="50" {}/>', 50),
        ('<path d="M50 0A50 50 0 0 1 0 50" {}/>', 50),
        ('<path d="M50 0A50 50 30 1 0 0 50" {}/>', None),
        ('<path d="M50 0A1 1 0 01-50 0" {}/>', 50),  # too small a radius grows
        ('<path d="M50 0C50 27.6142 27.6142 50 0 50" {}/>', 50),
    ],
)
def test_curves_stray_from_their_chords_by_little(shape: str, radius: float | None) -> None:
    found = np.array(points(shape.format('stroke="red"')))
    if radius is not None:
        assert np.allclose(np.hypot(*found.T), radius, atol=0.02)
        middles = (found[1:] + found[:-1]) / 2
        assert np.hypot(*middles.T).min() > radius - 0.2
    else:  # the long way round passes the far side
        assert np.hypot(*(found - [100 - 50, 50]).T).max() > 90
    assert "curves became chords" in drawn(shape.format('stroke="red"')).notes[0]


def test_a_smooth_curve_mirrors_the_handle_before() -> None:
    plain = points('<path d="M0 0C0 10 10 10 10 0C10 -10 20 -10 20 0" stroke="red"/>')
    smooth = points('<path d="M0 0C0 10 10 10 10 0S20-10 20 0" stroke="red"/>')
    assert np.allclose(plain, smooth)
    plain = points('<path d="M0 0Q5 10 10 0Q15 -10 20 0" stroke="red"/>')
    assert np.allclose(plain, points('<path d="M0 0Q5 10 10 0T20 0" stroke="red"/>'))


@pytest.mark.parametrize(
    "look",
    [
        'stroke="red"',
        'stroke="#f00"',
        'stroke="#FF0000"',
        'stroke="rgb(255,0,0)"',
        'stroke="rgb(100%,0%,0%)"',
        'stroke="rgb(255 0 0)"',
        'stroke="hsl(0,100%,50%)"',
        'style="stroke:red"',
        'style="fill:none;stroke : #ff0000 ;stroke-width:2"',
        'stroke="blue" style="stroke:red"',
        'class="st0"',
        'class="other st0" stroke="blue"',
        'id="one"',
        'class="st1" id="one"',
        'class="st2" stroke="green"',
        'stroke="currentColor" color="red"',
    ],
)
def test_red_is_red_however_it_is_said(look: str) -> None:
    sheet = (
        "<style>/* from a program */ .st0{fill:none;stroke:#FF0000;} #one{stroke:red}"
        "path.st2 , .never {stroke:red} .st1{stroke:blue}</style>"
    )
    drawing = drawn(f'{sheet}<path d="M0 0L9 9" {look}/>')
    assert drawing.looks[0].colour == (255, 0, 0)


def test_styles_are_inherited_and_the_nearest_holds() -> None:
    body = f'<g stroke="blue" style="stroke-opacity:.5">{LINE}<path d="M0 0L1 1"/></g>'
    first, second = drawn(body).looks
    assert (first.hex, second.hex) == ("#ff0000", "#0000ff")
    assert first.opacity == second.opacity == 0.5


@pytest.mark.parametrize(
    ("look", "share"),
    [
        ('opacity="0.25"', 0.25),
        ('stroke-opacity="0.25"', 0.25),
        ('style="opacity:.5;stroke-opacity:50%"', 0.25),
        ('opacity="0.5" stroke-opacity="0.5"', 0.25),
        ('opacity="7"', 1.0),
        ('opacity="much"', 1.0),
        ('opacity="-1"', 0.0),
    ],
)
def test_opacity_is_a_shares_of_the_fold(look: str, share: float) -> None:
    drawing = drawn(f'<g opacity="0.1"><path d="M0 0L9 9" stroke="red" {look}/></g>')
    assert drawing.looks[0].opacity == share  # a group's opacity is none of a crease's


def test_an_alpha_is_an_opacity() -> None:
    for paint in ("rgba(255,0,0,0.5)", "rgb(255 0 0 / 50%)"):
        assert drawn(f'<path d="M0 0L9 9" stroke="{paint}"/>').looks[0].opacity == 0.5
    assert drawn('<path d="M0 0L9 9" stroke="#ff000080"/>').looks[0].opacity == pytest.approx(
        128 / 255
    )


def test_layers_are_named_from_the_outside_in() -> None:
    body = (
        '<g inkscape:groupmode="layer" inkscape:label="Sheet 1" id="layer1">'
        f'<g id="mountains" class="a b">{LINE}</g></g>'
    )
    assert drawn(body).looks[0].layers == ("layer1", "Sheet 1", "mountains", "a", "b")


def test_what_is_not_seen_is_left_out_and_told() -> None:
    hidden = (
        '<path d="M0 0L5 5" stroke="blue" display="none"/>'
        '<g style="display:none"><path d="M0 0L5 5" stroke="blue"/></g>'
        '<g visibility="hidden"><path d="M0 0L5 5" stroke="blue"/></g>'
        '<path d="M0 0L5 5" stroke="none" fill="blue"/><text>V</text>'
        '<defs><path d="M0 0L5 5" stroke="blue"/></defs>'
    )
    drawing = drawn(LINE + hidden)
    assert len(drawing.segments) == 1
    assert drawing.notes == (
        "Left out, as they are no lines: 3 hidden parts, 1 shapes without a line, 1 texts.",
    )


def test_a_drawing_of_fills_alone_is_refused_with_what_to_do() -> None:
    with pytest.raises(UnreadableFile, match="2 of them, have no stroke"):
        drawn('<rect width="9" height="9" fill="red"/><circle r="2"/>')


def test_a_doctype_that_only_names_a_dtd_is_no_bomb() -> None:
    head = '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://nowhere.invalid/svg11.dtd">'
    drawing = svg.read((head + HEAD.format("", LINE)).encode())
    assert len(drawing.segments) == 1


def test_a_drawing_in_a_drawing_has_a_page_of_its_own() -> None:
    body = f'<svg x="5" y="6" width="20" height="20" viewBox="1 1 10 10">{LINE}</svg>'
    assert points(body) == [[3, 4], [23, 4]]


def test_an_arc_of_svg_is_where_the_standard_says() -> None:
    """Against the parametric form of the standard, from a centre chosen here."""
    chance = random.Random(3)
    for _ in range(25):
        rx, ry, tilt = chance.uniform(5, 30), chance.uniform(5, 30), chance.uniform(-90, 90)
        a, sweep = chance.uniform(0, 2 * pi), chance.uniform(0.1, 2 * pi - 0.1)
        way = chance.choice([1, -1])

        def at(t: float, rx: float = rx, ry: float = ry, phi: float = radians(tilt)) -> list[float]:
            x, y = rx * cos(t), ry * sin(t)
            return [7 + cos(phi) * x - sin(phi) * y, 9 + sin(phi) * x + cos(phi) * y]

        begin, end = at(a), at(a + way * sweep)
        flags = f"{int(sweep > pi)} {int(way > 0)}"
        data = f"M{begin[0]} {begin[1]}A{rx} {ry} {tilt} {flags} {end[0]} {end[1]}"
        found = np.array(points(f'<path d="{data}" stroke="red"/>'))
        steps = np.linspace(0, sweep, len(found))
        wanted = np.array([at(a + way * step) for step in steps])
        assert np.allclose(found, wanted, atol=1e-6)


def test_css_that_is_not_understood_is_told() -> None:
    drawing = drawn(f"<style>g > path {{cursor:help}} .a{{stroke:red}}</style>{LINE}")
    assert drawing.notes == ("1 rules of the style sheet are not understood.",)


def test_an_absurd_style_sheet_is_refused() -> None:
    rules = "".join(f"a.b{k}{{stroke:red}}" for k in range(1100))
    with pytest.raises(UnreadableFile, match="over 1000 selectors"):
        drawn(f"<style>{rules}</style>{LINE}")


@pytest.mark.parametrize("selector", ["g > path", "g path", "[id]", "@media screen {path"])
def test_css_that_could_lose_lines_or_turn_their_colour_is_refused(selector: str) -> None:
    with pytest.raises(UnreadableFile, match="looks like, a selector that is not understood"):
        drawn(f"<style>{selector.replace('>', '&gt;')} {{stroke:blue}}</style>{LINE}")


@pytest.mark.parametrize(
    "style",
    [
        "path{stroke:red !important}",
        "path{stroke:red ! IMPORTANT}",
        "path{stroke:red!important} #a{stroke:lime}",
        "path{stroke:red!important; stroke:lime}",
        "@charset 'utf-8'; @import url(x.css); path{stroke:red!important}",
        "path{stroke:red!important} @media print {path{fill:red} path{stroke:lime!important}}",
    ],
)
def test_what_is_important_stands_above_the_style_of_the_line(style: str) -> None:
    line = '<path id="a" d="M0 0L10 0" style="stroke:blue"/>'
    assert drawn(f"<style>{style}</style>{line}").looks[0].colour == (255, 0, 0)


def test_an_important_style_of_the_line_stands_above_all() -> None:
    line = '<path d="M0 0L10 0" style="stroke: red ! important"/>'
    found = drawn(f"<style>path{{stroke:blue!important}}</style>{line}")
    assert found.looks[0].colour == (255, 0, 0)


@pytest.mark.parametrize(
    "moved",
    [
        'style="transform:translate(5px,0)"',
        'class="moved"',
        'transform="rotate(90)" transform-origin="50 50"',
    ],
)
def test_lines_moved_by_styles_are_refused_and_not_misplaced(moved: str) -> None:
    rules = "<style>.moved{transform:rotate(90deg)}</style>"
    with pytest.raises(UnreadableFile, match="transforms in styles"):
        drawn(f"{rules}<g {moved}>{LINE}</g>")


@pytest.mark.parametrize(
    "size", ["", 'width="10" height="10"', 'width="10" height="10" preserveAspectRatio="xMinYMin"']
)
def test_a_drawing_in_a_drawing_of_other_proportions_is_refused(size: str) -> None:
    with pytest.raises(UnreadableFile, match="other proportions"):
        drawn(f'<svg {size} viewBox="0 0 10 5">{LINE}</svg>')


def test_a_colour_said_twice_for_printers_is_that_colour() -> None:
    line = '<path d="M0 0L10 0" style="stroke:#ff0000 icc-color(x, 1, 0, 0)"/>'
    assert drawn(line).looks[0].colour == (255, 0, 0)


def test_maps_beyond_all_numbers_are_refused_in_one_sentence() -> None:
    moved = f'<g transform="scale(1e300)"><g transform="scale(1e300)">{LINE}</g></g>'
    with pytest.raises(UnreadableFile, match="not all numbers within a billion"):
        drawn(moved)


@pytest.mark.parametrize("bomb", ["@import ", "@media print ", "/*", "@media print{", "a{"])
def test_style_sheets_without_end_are_read_in_one_go(bomb: str) -> None:
    drawing = drawn(f"<style>{bomb * 100_000}</style>{LINE}")
    assert drawing.looks[0].colour == (255, 0, 0)


def test_a_mile_of_spaces_is_read_in_one_go() -> None:
    mile = " " * 300_000
    line = f'<path d="M0 0L10 0" style="stroke:red{mile}x" stroke="{mile}"/>'
    with pytest.raises(UnreadableFile, match="no lines"):
        drawn(f'<path d="M0 0L10 0" stroke="{mile}"/>')
    assert drawn(line).looks[0].colour is None


@pytest.mark.parametrize(
    ("end", "rx", "ry"),
    [((9.0, 5.0), 1e-320, 22.0), ((0.0, 5.0), 1e-320, 22.0), ((1e-300, 0.0), 1.0, 1.0)],
)
def test_an_arc_of_a_radius_or_a_span_that_is_nothing_is_a_straight_line(
    end: tuple[float, float], rx: float, ry: float
) -> None:
    chords = curves.arc((0.0, 0.0), end, rx, ry, 26.0, large=True, sweep=False)
    assert chords.tolist() == [list(end)]
