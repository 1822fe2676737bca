"""A strap that closes a slit is a piece of the sheet itself: it lies flush upon the closed form."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
import shapely.affinity
from slit_forms import PRESETS, form, space
from stools import machine, material

from foldmill import Assignment, Fold, ImpossibleGeometry, InvalidParameters
from foldmill.check import check
from foldmill.exchange import fold as fold_file
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import verify
from foldmill_plugins.rotational import DESIGN

EVERY = pytest.mark.parametrize("name", PRESETS)


def strap(name: str, width: float = 8.0) -> Fold:
    return DESIGN.run(DESIGN.preset(name).model_dump() | {"slit": True, "strap": width})


def mouth(name: str) -> np.ndarray:
    fold = form(name, slit=True)
    assert fold.folded is not None
    spot: np.ndarray = fold.pattern.vertices[fold.folded.seams[-1, 0]]
    return spot


def area_of(fold: Fold) -> shapely.Geometry:
    return shapely.union_all(shapely.polygons(fold.pattern.vertices[fold.pattern.faces]))


@EVERY
@pytest.mark.parametrize("width", [2.0, 8.0, 15.0])
def test_it_is_a_sheet_that_folds(name: str, width: float) -> None:
    piece = strap(name, width)
    assert not check(piece).findings
    pattern = piece.pattern
    assert len(pattern.vertices) - len(pattern.edges) + len(pattern.faces) == 1
    text = fold_file.write(piece)
    assert fold_file.write(fold_file.read(text)) == text


@EVERY
def test_it_is_the_strip_of_the_sheet_about_the_slit(name: str) -> None:
    """Both banks under it for as far as it goes, to the outline, and never beyond the sheet."""
    piece, sheet, end = strap(name), form(name, slit=False), mouth(name)
    slit = shapely.LineString([(0, 0), end])
    area, whole = area_of(piece), area_of(sheet)
    assert area.difference(whole).area < 1e-6
    across = piece.pattern.vertices @ np.array([-end[1], end[0]]) / np.hypot(*end)
    along = piece.pattern.vertices @ end / np.hypot(*end)
    assert (across.min(), across.max()) == pytest.approx((-8, 8))
    start = along.min()
    assert 8.0 < start < 0.5 * np.hypot(*end)
    beyond = shapely.box(start, -8.0, 2 * np.hypot(*end), 8.0)
    turned = shapely.affinity.rotate(
        beyond, float(np.degrees(np.arctan2(end[1], end[0]))), origin=(0, 0)
    )
    assert area.area == pytest.approx(turned.intersection(whole).area, rel=1e-9)
    assert slit.difference(area.buffer(1e-9)).length == pytest.approx(start)


@EVERY
def test_it_lies_flush_upon_the_closed_form(name: str) -> None:
    """Every corner of the strap is where the sheet has the same place, to a hair."""
    piece, sheet = strap(name), form(name, slit=False)
    spots, solid = sheet.pattern.vertices[sheet.pattern.faces], space(sheet)[sheet.pattern.faces]
    for flat, there in zip(piece.pattern.vertices, space(piece), strict=True):
        step = spots[:, 1:] - spots[:, :1]
        shares = np.linalg.solve(np.swapaxes(step, 1, 2), (flat - spots[:, 0])[..., None])[..., 0]
        inside = (shares >= -1e-9).all(axis=1) & (shares.sum(axis=1) <= 1 + 1e-9)
        places = solid[:, 0] + np.einsum("fk,fkj->fj", shares, solid[:, 1:] - solid[:, :1])
        assert inside.any()
        assert np.abs(places[inside] - there).max() < 1e-9


@EVERY
def test_it_has_the_crease_of_the_slit_with_the_angle_the_sheet_would_fold_there(name: str) -> None:
    piece, sheet, end = strap(name), form(name, slit=False), mouth(name)
    found = [angles_along(fold, end) for fold in (sheet, piece)]
    assert found[1]
    assert set(found[1]) <= set(found[0])
    assert max(found[1]) == max(found[0])


def angles_along(fold: Fold, end: np.ndarray) -> dict[tuple[float, float], float]:
    """Return the creases on the line from the centre to ``end``: outer end → fold angle."""
    pattern, across = fold.pattern, np.array([-end[1], end[0]]) / np.hypot(*end)
    on_line = (np.abs(pattern.vertices @ across) < 1e-6) & (pattern.vertices @ end > -1e-6)
    found = {}
    for (a, b), angle in zip(pattern.edges, pattern.fold_angles, strict=True):
        if on_line[a] and on_line[b]:
            outer = float(max(np.hypot(*pattern.vertices[[a, b]].T)))
            found[round(outer, 6), round(float(angle), 6)] = float(angle)
    return found


@EVERY
def test_it_is_planned_and_proved_as_a_sheet_of_its_own(name: str) -> None:
    piece = strap(name)
    plan = make(piece, material(), machine())
    assert verify(plan, piece.pattern, hpgl.write(plan, piece)).findings == ()
    assert piece.meta["title"] == "Strap over a slit, 8 mm to either side"
    assert piece.pattern.count(Assignment.C) == 0


def test_a_strap_without_a_slit_is_refused() -> None:
    with pytest.raises(InvalidParameters, match="A strap closes a slit, and this form has none"):
        DESIGN.run({"strap": 8.0})


def test_a_strap_that_is_too_wide_is_refused_with_the_width_that_fits() -> None:
    with pytest.raises(ImpossibleGeometry, match=r"must be narrower than (\d+\.\d+) mm") as error:
        strap("bowl-n8", 60.0)
    widest = float(str(error.value).split("narrower than ")[1].split()[0])
    assert 20 < widest < 60
    assert not check(strap("bowl-n8", widest - 0.01)).findings
    with pytest.raises(ImpossibleGeometry):
        strap("bowl-n8", widest + 0.01)


def test_random_forms_have_straps_that_fold() -> None:
    chance = np.random.default_rng(7)
    for _ in range(40):
        count = int(chance.integers(2, 8))
        steps = 40 + 14 * np.arange(count) + chance.uniform(0, 12, count)
        points = {
            i: {"a": float(a), "branch": int(chance.choice((-1, 1)))}
            for i, a in enumerate(steps, start=1)
        }
        values = {"n": int(chance.integers(3, 12)), "phi": float(chance.uniform(30, 150))}
        whole = check(DESIGN.run({**values, "points": points}))
        piece = DESIGN.run({**values, "points": points, "slit": True, "strap": 5.0})
        codes = {finding.code for finding in check(piece).findings}
        assert codes <= {finding.code for finding in whole.findings}
