"""Axisymmetric forms from rotationally symmetric patterns (thesis chapter 3)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from foldmill import Angle, Coordinate, Count, Design, Fold, Params, hookimpl
from foldmill.axisymmetric import (
    along_arc,
    closed,
    closing,
    handles,
    many,
    many_rosettes,
    rosette,
    slit,
    strap,
    strip,
    unfold,
)
from foldmill.axisymmetric.free import STEP_DEG, free_intervals, is_free
from foldmill.axisymmetric.points import LinePoint, LinePoints
from foldmill.axisymmetric.rosette import HalfWedge, Rosette
from foldmill.axisymmetric.slit import SlitRosette
from foldmill.axisymmetric.strip import Strip
from foldmill.folded import FoldedForm
from foldmill.motion import Motion


def _points(words: str) -> dict[int, LinePoint]:
    """Read points as "a" or "a-" (the other branch), from the innermost one outwards."""
    return {
        i: LinePoint(a=float(word.rstrip("-")), branch=-1 if word.endswith("-") else 1)
        for i, word in enumerate(words.split(), start=1)
    }


def _bowl() -> dict[int, LinePoint]:
    return _points("40 56 76 100- 117 121-")


class RotationalParams(Params):
    """N wedges, an opening angle and the points of one half wedge."""

    n: Count = Field(default=8, ge=3, le=72)
    """Order of rotational symmetry: how many wedges go round."""
    phi: Angle = Field(default=75.0, ge=0, le=180)
    """Angle between the innermost crease and the axis; 90 is the flat sheet."""
    points: LinePoints = Field(default_factory=_bowl)
    """Points p_1, p_2 … outwards: odd ones on line l1, even ones on line l2, 180°/N from it."""
    slit: bool = False
    """Whether the sheet is cut along one line l2, from its centre through p_2, p_4 … to the
    outline, so that it folds flat along the arc."""
    strap: Coordinate = Field(default=0.0, ge=0)
    """Width, on either side of the slit, of the strap that is glued over it to close it. Above 0 it
    is the strap that is made, a second sheet; 0 makes the form."""

    @model_validator(mode="after")
    def _strap_needs_a_slit(self) -> Self:
        if self.strap and not self.slit:
            raise ValueError("a strap closes a slit, and this form has none; set slit to true")
        return self


def generate(params: RotationalParams) -> Fold:
    """Solve the strip and turn it into the whole form.

    Raises InvalidParameters for contradicting points, ImpossibleGeometry where one has no place.
    """
    solved = strip.solve(params.n, params.phi, dict(params.points))
    half = HalfWedge.of(solved)
    if params.strap:
        return _strap(half, params)
    rose = slit.assemble(half) if params.slit else rosette.assemble(half)
    fold = _closed(rose, params)
    moves = {move.name: move for move in _motions(rose, solved, params)}
    grips = handles.handles(fold, rose, params)
    return replace(fold, motions=moves, handles=grips, meta=_facts(moves.get("along-arc")))


def _closed(rose: Rosette, params: RotationalParams) -> Fold:
    signs = closed.signs(rose.half, params.phi, params.points)
    return rosette.fold(rose, signs, wedge_decides=True)


def _strap(half: HalfWedge, params: RotationalParams) -> Fold:
    opened, whole = slit.assemble(half), rosette.assemble(half)
    mouth = opened.flat[opened.seams[-1, 0]]
    if rosette.is_inside_out(whole):
        mouth = mouth * np.array([1.0, -1.0])
    fold, form = _closed(whole, params), FoldedForm(whole.spatial)
    return strap.cut(fold, form, mouth, params.n, params.strap)


def _facts(folding: Motion | None) -> dict[str, object]:
    if folding is None:
        return {}
    return {"along-arc": {"folding_rate": 100 * folding.reach, "stops": folding.reason}}


def _motions(rose: Rosette, solved: Strip, params: RotationalParams) -> Iterator[Motion]:
    yield unfold.motion(rose, params.n, params.phi, params.points)
    if isinstance(rose, SlitRosette):
        yield slit.motion(rose, solved, _branches(params))


def _branches(params: RotationalParams) -> dict[int, int]:
    return {i: point.branch for i, point in params.points.items() if i >= 2}


def free_phi(params: RotationalParams) -> dict[str, object]:
    """Report at which opening angles the form passes through nothing.

    Raises InvalidParameters and ImpossibleGeometry as ``generate`` does.
    """
    strip.solve(params.n, params.phi, params.points)
    return {
        "phi_deg": params.phi,
        "free_at_phi": is_free(params.n, params.phi, params.points),
        "free_deg": [list(span) for span in free_intervals(params.n, params.points)],
        "looked_at_every_deg": STEP_DEG,
    }


def flat_foldability(params: RotationalParams) -> dict[str, object]:
    """Report whether the form, cut along p_0-p_2-p_4-…, folds flat along the arc.

    Raises InvalidParameters and ImpossibleGeometry as ``generate`` does.
    """
    solved = strip.solve(params.n, params.phi, dict(params.points))
    rose = rosette.assemble(rosette.HalfWedge.of(solved))
    branches = _branches(params)
    places = partial(along_arc.meridians, solved, branches)
    front = -1 if rosette.is_inside_out(rose) else 1
    return closing.report(closing.Closing(rose, branches, places, 0, front))


# Chosen by eye from seeded random forms that pass through nothing; none needs a sheet over 260 mm.
# The lampshade's 24 creases in one point want a thinner material than half-cut 0.75 mm
# polypropylene: its grooves would end 0.196 mm apart there, and a plan says so.
PRESETS = {
    "bowl-n8": RotationalParams(),
    "crown-n6": RotationalParams(n=6, phi=80, points=_points("31 58 84 86- 123 128")),
    "lampshade-n12": RotationalParams(n=12, phi=120, points=_points("56 77- 84- 116 129-")),
    "star-n6": RotationalParams(n=6, phi=100, points=_points("50 79- 87- 117 113")),
}

DESIGN = Design(
    slug="rotational",
    title="Axisymmetric form from a rotationally symmetric pattern",
    params=RotationalParams,
    generate=generate,
    presets=PRESETS,
    reports={"flat-foldability": flat_foldability, "free-phi": free_phi},
    references=("Y. Zhao, Design Methods for Triangle-based 3D Origami, chapter 3",),
)
DESIGN = replace(DESIGN, batch=many.batch_of(DESIGN, many_rosettes.prepare))


@hookimpl
def foldmill_designs() -> list[Design[RotationalParams]]:
    """Offer the family."""
    return [DESIGN]
