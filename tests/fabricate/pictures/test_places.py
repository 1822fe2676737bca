"""The picture of what planning found marks each place once, errors first."""

from __future__ import annotations

import numpy as np
import pytest
import stools
from slit_forms import form

from foldmill.finding import Finding, Severity
from foldmill_fabricate.formats import places as places_format
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
