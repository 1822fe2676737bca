"""Axisymmetric forms from rotationally symmetric patterns (thesis chapter 3)."""

from __future__ import annotations

from pydantic import Field

from foldmill import Angle, Count, Design, Fold, Params, hookimpl
from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.points import LinePoint, LinePoints


class RotationalParams(Params):
    """N wedges, an opening angle and the points of one half wedge."""

    n: Count = Field(8, ge=3, le=72)
    """Order of rotational symmetry: how many wedges go round."""
    phi: Angle = Field(66.0, ge=0, le=180)
    """Angle between the innermost crease and the axis; 90 is the flat sheet."""
    points: LinePoints = Field(
        default_factory=lambda: {
            1: LinePoint(a=40),
            2: LinePoint(a=62),
            3: LinePoint(a=92),
            4: LinePoint(a=118),
        }
    )
    """Points p_1, p_2 … outwards: odd ones on line l1, even ones on line l2, 180°/N from it."""


def generate(params: RotationalParams) -> Fold:
    """Solve the strip and turn it into the whole form."""
    solved = strip.solve(params.n, params.phi, dict(params.points))
    return rosette.fold(rosette.assemble(rosette.HalfWedge.of(solved)), wedge_decides=True)


def _preset(n: int, phi: float, points: str) -> RotationalParams:
    """Read points as "a" or "a-" (the other branch), from the innermost one outwards."""
    numbered = enumerate(points.split(), start=1)
    return RotationalParams(
        n=n,
        phi=phi,
        points={
            i: LinePoint(a=float(word.rstrip("-")), branch=-1 if word.endswith("-") else 1)
            for i, word in numbered
        },
    )


DESIGN = Design(
    slug="rotational",
    title="Axisymmetric form from a rotationally symmetric pattern",
    params=RotationalParams,
    generate=generate,
    presets={},
    references=("Zhao, thesis, chapter 3: rotationally-symmetric crease patterns",),
)


@hookimpl
def foldmill_designs() -> list[Design[RotationalParams]]:
    """Offer the family."""
    return [DESIGN]
