"""Whether layers find an order: known sheets, and strips against every order there is."""

from __future__ import annotations

from itertools import accumulate, permutations
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from foldmill import CreasePattern, Fold
from foldmill.check import flat_foldability, layers
from foldmill.exchange import read

SAMPLES = Path(__file__).parents[2] / "samples"


def sample(name: str) -> Fold:
    return read((SAMPLES / name).read_text("utf-8"))


def test_a_twist_whose_vertices_all_fold_cannot_be_folded_as_a_whole() -> None:
    twist = sample("ff_bad-twist-UNSAT.fold")
    assert not flat_foldability(twist).has_errors  # Kawasaki and Maekawa see nothing
    report = layers(twist)
    assert report.figures["layer_order"] == "none"
    (finding,) = report.findings
    assert finding.code == "layer-order"
    assert finding.where.startswith("edge ")
    assert finding.at is not None


@pytest.mark.parametrize("name", ["ff_pinwheel.fold", "fold_diagonal-cp.fold"])
def test_a_sheet_that_people_fold_has_an_order(name: str) -> None:
    report = layers(sample(name))
    assert report.figures["layer_order"] == "found"
    assert not report.findings


def strip(lengths: list[int], letters: str) -> Fold:
    """Return a strip of paper with a crease after every panel but the last."""
    places = [0, *accumulate(lengths)]
    count = len(places)
    points = [[10 * x, y] for y in (0, 10) for x in places]
    edges = [
        *([k, k + 1] for k in range(count - 1)),
        *([count + k, count + k + 1] for k in range(count - 1)),
        *([k, count + k] for k in range(count)),
    ]
    sides = "B" * (2 * (count - 1))
    return Fold(CreasePattern.from_lines(points, edges, f"{sides}B{letters}B"))


def folds_by_some_order(lengths: list[int], letters: str) -> bool:
    """Try every order of the panels of a strip, bottom to top."""
    way, spans, ends = 0, [], []
    for k, length in enumerate(lengths):
        start, way = way, way + (length if k % 2 == 0 else -length)
        spans.append((min(start, way), max(start, way)))
        ends.append(way)
    for order in permutations(range(len(lengths))):
        height = {panel: k for k, panel in enumerate(order)}
        if all(_holds(k, letters, spans, ends, height) for k in range(len(letters))):
            return True
    return False


def _holds(
    k: int, letters: str, spans: list[tuple[int, int]], ends: list[int], height: dict[int, int]
) -> bool:
    is_above = (letters[k] == "V") == (k % 2 == 0)
    if (height[k + 1] > height[k]) != is_above:
        return False
    low, high = sorted((height[k], height[k + 1]))
    for other, (left, right) in enumerate(spans):
        if other not in {k, k + 1} and left < ends[k] < right and low < height[other] < high:
            return False
    for other in range(len(letters)):
        if abs(other - k) > 1 and ends[other] == ends[k] and other % 2 == k % 2:
            within = [low < height[panel] < high for panel in (other, other + 1)]
            if within[0] != within[1]:
                return False
    return True


STRIPS = st.integers(2, 6).flatmap(
    lambda n: st.tuples(
        st.lists(st.integers(1, 4), min_size=n, max_size=n),
        st.text("MV", min_size=n - 1, max_size=n - 1),
    )
)


@given(STRIPS)
@example(([3, 1, 3], "VV"))
@example(([3, 1, 3], "MV"))
@example(([2, 1, 1, 2], "VVV"))
@settings(max_examples=100)
def test_a_strip_folds_flat_where_some_order_of_its_panels_does(
    drawn: tuple[list[int], str],
) -> None:
    lengths, letters = drawn
    found = layers(strip(lengths, letters)).figures["layer_order"]
    assert (found == "found") == folds_by_some_order(lengths, letters)
    assert found != "not checked"


def test_a_crimp_folds_with_both_creases_unlike_and_not_alike() -> None:
    assert not layers(strip([3, 1, 3], "MV")).has_errors
    assert layers(strip([3, 1, 3], "VV")).has_errors


def test_a_sheet_that_does_not_close_is_told_by_how_much() -> None:
    points = [[0, 0], [100, 0], [100, 100], [0, 100], [50, 50]]
    edges = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]]
    skew = [*points[:4], [60, 50]]
    report = layers(Fold(CreasePattern.from_lines(skew, edges, "BBBBMMMV")))
    (finding,) = report.findings
    assert finding.code == "flat-open"
    assert "fails to close by" in finding.message


@pytest.mark.parametrize(
    ("letters", "angle", "said"),
    [
        ("BBBBU", 0.0, "neither mountain nor valley"),
        ("BBBBF", 0.0, "no creases"),
        ("BBBBV", 90.0, "fold only partly"),
    ],
)
def test_what_need_not_fold_flat_is_not_judged(letters: str, angle: float, said: str) -> None:
    square = [[0, 0], [9, 0], [9, 9], [0, 9]]
    lines = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]]
    report = layers(Fold(CreasePattern.from_lines(square, lines, letters, [0, 0, 0, 0, angle])))
    (finding,) = report.findings
    assert said in finding.message
    assert report.figures == {"layer_order": "not checked"}
