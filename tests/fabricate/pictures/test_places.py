"""The picture of what planning found marks each place once, errors first."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
import stools
from fabricate.plan.test_make import square
from slit_forms import form

from foldmill.finding import Finding, Severity
from foldmill_fabricate.formats import places as places_format
from foldmill_fabricate.pictures import canvas, sheet
from foldmill_fabricate.pictures.places import places, places_picture
from foldmill_fabricate.plan import make
from foldmill_fabricate.sheet import placed


def test_the_tight_centre_of_the_lampshade_is_one_place() -> None:
    fold = form("lampshade-n12", slit=False)
    plan = make(fold, stools.material(), stools.machine())
    [place] = places(plan.findings)
    assert place.finding.code == "vertex-rule"
    assert place.times == sum(finding.code == "vertex-rule" for finding in plan.findings)
    spots = placed(fold.pattern.vertices, plan.placement)
    assert np.hypot(*(spots - place.at).T).min() < plan.material.score.setback + 0.1
    written = places_format.write(plan, fold)
    assert written["places.png"].startswith(b"\x89PNG")
    assert written["places.png"] == places_picture(plan)


@pytest.mark.parametrize("apart", [0.0, 2.9, 3.1])
def test_findings_of_one_kind_are_told_together_where_they_are_near(apart: float) -> None:
    def found(code: str, severity: Severity, x: float) -> Finding:
        return Finding(code, severity, "here", "It is wrong.", at=(x, 0.0))

    told = places(
        [
            Finding("nowhere", Severity.ERROR, "", "It has no place."),
            found("a", Severity.WARNING, 0.0),
            found("a", Severity.WARNING, apart),
            found("b", Severity.ERROR, 0.0),
        ]
    )
    assert [place.finding.code for place in told] == (["b", "a"] if apart < 3 else ["b", "a", "a"])
    assert sum(place.times for place in told) == 3


@pytest.mark.parametrize("flip", ["left-right", "end-over-end"])
def test_how_the_sheet_is_turned_over_is_written_within_the_picture(
    flip: Literal["left-right", "end-over-end"],
) -> None:
    plan = make(
        square("MVMV", 90), stools.material(), stools.machine(), blank=(200, 200), flip=flip
    )
    with canvas.own_style():
        figure = canvas.figure(200, 290)
        axes = canvas.flat_axes(figure, (0.03, 0.32, 0.94, 0.62))
        sheet.draw(axes, plan)
        canvas.png(figure)
        [words] = [each for each in axes.texts if "turned over" in each.get_text()]
        box = words.get_window_extent()
    assert flip in words.get_text()
    assert 0 <= box.x0 < box.x1 <= figure.bbox.width
    assert 0 <= box.y0 < box.y1 <= figure.bbox.height
