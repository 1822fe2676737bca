"""Creases that fold alike stand in one row of the table, wherever the pattern lies."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import Assignment, CreasePattern, Fold, installed
from foldmill_fabricate.jobsheet.creases import MOST_GROUPS, arrange, groups


def made(family: str, preset: str) -> Fold:
    design = installed().design(family)
    return design.run(design.preset(preset))


def uneven() -> CreasePattern:
    """Return a strip whose 58 creases all fold by another angle."""
    x = np.arange(60.0) * np.linspace(1, 2, 60)
    flat = np.vstack([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + 40])])
    rim = [(k, k + 1) for k in range(59)] + [(60 + k, 61 + k) for k in range(59)]
    edges = [*rim, (0, 60), (59, 119), *((k, 60 + k) for k in range(1, 59))]
    angles = [0.0] * 120 + [(-1) ** k * (10 + 2.5 * k) for k in range(58)]
    return CreasePattern.from_lines(flat, edges, "B" * 120 + "VM" * 29, angles)


@pytest.mark.parametrize(
    ("family", "preset", "kind"),
    [
        ("tuck", "stool-n8", "rings"),
        ("tuck", "basket-n10", "rings"),
        ("rotational", "lampshade-n12", "rings"),
        ("six-crease", "vase", "rows"),
    ],
)
def test_a_form_with_an_axis_has_few_kinds_of_creases_each_with_one_angle(
    family: str, preset: str, kind: str
) -> None:
    fold = made(family, preset)
    how = arrange(fold.pattern)
    assert how.kind == kind
    assert fold.symmetry is not None
    for group in how.groups:
        assert group.spread < 0.05
        assert len(group.edges) >= fold.symmetry.order - 1  # a row of a strip may miss its seam
        places = fold.pattern.vertices[fold.pattern.edges[group.edges]].mean(axis=1)
        if kind == "rows":
            assert np.ptp(places[:, 1]) < 0.3
    order = [(group.is_closed, round(group.distance, 3)) for group in how.groups]
    assert order == sorted(order)


def test_angles_that_are_all_another_are_told_in_ranges_that_hold_them_all() -> None:
    pattern = uneven()
    how = arrange(pattern)
    assert how.kind == "none"
    assert 2 <= len(how.groups) <= MOST_GROUPS
    assert sum(len(group.edges) for group in how.groups) == 58
    for group in how.groups:
        angles = np.abs(pattern.fold_angles[group.edges])
        assert group.spread == pytest.approx(np.ptp(angles))
        assert np.abs(angles - group.angle).max() <= group.spread


def test_creases_that_are_alike_all_over_the_sheet_lie_in_no_rings() -> None:
    how = arrange(made("waterbomb", "egg-crate").pattern)
    assert how.kind == "none"
    assert len(how.groups) <= 6


def test_a_sheet_without_creases_has_no_groups() -> None:
    square = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)]
    plain = CreasePattern.from_lines(square, [(0, 1), (1, 2), (2, 3), (3, 0)], "BBBB")
    assert groups(plain) == []


def test_a_mountain_and_a_valley_are_never_one_kind() -> None:
    for family, preset in (("waterbomb", "vase"), ("tuck", "flush-n6")):
        pattern = made(family, preset).pattern
        for group in groups(pattern):
            assert set(pattern.assignments[group.edges].tolist()) == {group.assignment}
            assert group.assignment in (Assignment.M, Assignment.V)
