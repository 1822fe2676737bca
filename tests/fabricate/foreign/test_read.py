"""Foreign HP-GL is read to the strokes that a plotter would draw, or refused with the byte."""

from __future__ import annotations

from itertools import pairwise
from math import hypot

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill.errors import UnreadableFile
from foldmill_fabricate.foreign import limits, read
from foldmill_fabricate.foreign.arcs import chords
from foldmill_fabricate.foreign.scaling import Scale

Path = tuple[tuple[float, float], ...]


def drawn(text: str) -> dict[int, list[Path]]:
    found = read(text.encode("latin-1"), "a.plt").pens
    return {number: list(own) for number, own in found.items()}


def one(text: str) -> Path:
    ((path,),) = drawn(text).values()
    return path


places = st.tuples(st.integers(-30_000, 30_000), st.integers(-30_000, 30_000))
ways = st.lists(places, min_size=2, max_size=8).filter(
    lambda way: all(a != b for a, b in pairwise(way))
)


@given(st.lists(st.tuples(st.integers(1, 8), ways, st.booleans()), min_size=1, max_size=5))
def test_lines_are_where_they_were_drawn_absolute_or_by_differences(
    strokes: list[tuple[int, list[tuple[int, int]], bool]],
) -> None:
    text, wanted = "IN;", dict[int, list[Path]]()
    for pen, way, relative in strokes:
        (x, y), *rest = way
        steps = [(u - a, v - b) for (a, b), (u, v) in pairwise(way)] if relative else rest
        pairs = ",".join(f"{u},{v}" for u, v in steps)
        text += f"SP{pen};PA;PU{x} {y};{'PR;' if relative else ''}pd{pairs};PU;"
        wanted.setdefault(pen, []).append(tuple((u / 40, v / 40) for u, v in way))
    assert drawn(text) == wanted


@given(
    st.floats(0.05, 800),
    st.floats(-360, 360).filter(lambda sweep: abs(sweep) > 1),
    st.floats(0, 360),
)
def test_an_arc_is_no_farther_from_its_circle_than_is_said(
    radius: float, sweep: float, begin: float
) -> None:
    angle = np.radians(begin)
    x, y = 40 * radius * np.cos(angle), 40 * radius * np.sin(angle)
    path = np.array(one(f"PU{x:.4f},{y:.4f};PD;AA0,0,{sweep:.4f};PU;"))
    middles = (path[1:] + path[:-1]) / 2
    assert np.abs(np.hypot(*path.T) - radius).max() < 1e-3
    assert (radius - np.hypot(*middles.T)).max() <= limits.TOLERANCE_MM + 1e-3
    cross = path[:-1, 0] * path[1:, 1] - path[:-1, 1] * path[1:, 0]
    turned = np.degrees(np.arctan2(cross, (path[:-1] * path[1:]).sum(axis=1)).sum())
    assert abs(turned - sweep) < 0.1


@given(st.floats(0.001, 1e5), st.floats(0.001, 360))
def test_one_chord_fewer_would_stray_too_far(radius: float, sweep: float) -> None:
    count = chords(radius, sweep, 0.4)
    half = np.radians(sweep) / count / 2
    assert radius <= 0.4 or radius * (1 - np.cos(half)) <= 0.4 * (1 + 1e-6)
    if count > 1 and radius > 0.4:
        wider = np.radians(sweep) / (count - 1) / 2
        assert radius * (1 - np.cos(min(wider, np.pi))) > 0.4 * (1 - 1e-6)


def test_a_circle_is_drawn_whatever_the_pen_does_and_leaves_it_at_the_centre() -> None:
    first, circle, last = drawn("PU0,0;PD400,0;CI200;PD400,400;PU;")[1]
    assert first == ((0.0, 0.0), (10.0, 0.0))
    assert circle[0] == circle[-1] == (15.0, 0.0)
    assert {round(hypot(x - 10, y), 9) for x, y in circle} == {5.0}
    assert last == ((10.0, 0.0), (10.0, 10.0))


def test_a_full_arc_ends_exactly_where_it_began() -> None:
    path = one("PU400,7;PD;AA0,0,360;PU;")
    assert path[0] == path[-1]


@given(
    st.tuples(*[st.integers(-9000, 9000)] * 4).filter(lambda p: p[0] != p[2] and p[1] != p[3]),
    st.tuples(*[st.integers(-500, 500)] * 4).filter(lambda p: p[0] != p[1] and p[2] != p[3]),
)
def test_user_units_run_between_the_points_of_ip(
    points: tuple[int, ...], units: tuple[int, ...]
) -> None:
    (x1, y1, x2, y2), (left, right, low, high) = points, units
    corners = ",".join(map(str, points))
    path = one(f"IP{corners};SC{left},{right},{low},{high};PU{left},{low};PD{right},{high};PU;")
    assert np.allclose(path, np.array([(x1, y1), (x2, y2)]) / 40, atol=1e-9)
    scale = Scale().between([float(p) for p in points]).scaled([float(u) for u in units])
    assert np.allclose(scale.user(*scale.point(3.0, 4.0)), (3.0, 4.0))


def test_scaling_ends_with_sc_alone_and_stays_where_the_pen_is() -> None:
    path = one("IP0,0,4000,4000;SC0,10,0,10;PU5,5;PD10,5;SC;PD0,0;PU;")
    assert path == ((50.0, 50.0), (100.0, 50.0), (0.0, 0.0))


def test_speeds_and_forces_of_the_file_are_told_and_not_followed() -> None:
    found = read(b"VS10;FS90;VS20;PD;PU;PU0,0;PD40,0;PU;LT;", "a.plt")
    assert [remark[:8] for remark in found.remarks] == ["1 times:", "2 times:", "1 times:"]
    assert found.pens == {1: (((0.0, 0.0), (1.0, 0.0)),)}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("IN;PU0,0;LBwords;PD\x03;PD9,9;", "byte 9: LB writes words"),
        ("IN;LT2;", "byte 3: LT draws dashes"),
        ("IN;RO90;", "byte 3: RO turns the sheet"),
        ("IN;PE<=abc;", "byte 3: PE holds encoded lines"),
        ("IN;OA;", "byte 3: OA asks the machine something"),
        ("IN;XY1;", "byte 3: XY is not on the list"),
        ("\x1b.(IN;", "byte 0: there is an escape sequence"),
        ("IN;\x00PD1,1;", "byte 3: there is 0x00"),
        ("IN;PD1,2,3;", "byte 3: PD has 3 coordinates"),
        ("IN;PD1,x;", "byte 3: PD has 1 coordinates"),
        ("IN;PD1e9,1;", "byte 6: there is 0x65"),
        ("IN;PD1..2,1;", "holds '1..2', where a number belongs"),
        ("IN;PD" + "9" * 30 + ",1;", "where a number belongs"),
        ("IN;PD99999999,1;", "byte 3: PD leads farther than 20,000 mm away"),
        ("SC0,1,0,1;", "put IP before it"),
        ("IP0,0,100,100;SC0,1,0,1,1;", "SC scales otherwise than by four numbers"),
        ("IP;", "IP sets points that depend on the machine"),
        ("IP0,0,0,9;", "nothing between them"),
        ("IP0,0,9,9;SC1,1,0,1;", "an empty range"),
        ("PU0,0;CI400,120;", "chords of 120 degrees, which is no curve"),
        ("PD;AA0,0,720;", "more than once round"),
        ("PD;CI99999999;", "an arc of more than"),
        ("SP1;PD10,10;SP2;", "changes the pen while it is down"),
        ("SP0;PU0,0;PD10,10;PU;", "drawn without a pen"),
        ("SP0;PU0,0;PD10,10", "drawn without a pen"),
        ("SP1.5;", "chooses no pen"),
        ("IN;PU;", "draws nothing"),
        ("", "draws nothing"),
    ],
)
def test_what_is_not_on_the_list_is_named_with_its_byte(text: str, told: str) -> None:
    with pytest.raises(UnreadableFile) as refused:
        read(text.encode("latin-1"), "a.plt")
    assert told in str(refused.value)


def test_every_refused_instruction_is_named_and_the_rest_counted() -> None:
    with pytest.raises(UnreadableFile) as refused:
        read(b"PD1,1;" + b"RO90;" * 11, "a.plt")
    said = str(refused.value)
    assert [f"byte {6 + 5 * k}: RO" in said for k in range(9)] == [True] * 8 + [False]
    assert "and 3 more" in said


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b" " * (limits.BYTES + 1), "8,000,000 at the most"),
        (b"PU;" * (limits.INSTRUCTIONS + 1), "more than 200,000 instructions"),
        (b"PD" + b"1,1,2,2," * limits.POINTS + b"1,1;", "more than 100,000 corners"),
        (b"PU9,9;" + b"CI700000;" * 200, "more than 100,000 corners by byte"),
    ],
    ids=["bytes", "instructions", "corners", "arcs"],
)
def test_a_bomb_is_refused_by_size(data: bytes, told: str) -> None:
    with pytest.raises(UnreadableFile, match=told):
        read(data, "bomb.plt")
