"""Axisymmetric tubes of generic six-crease bases (thesis chapter 5)."""

from __future__ import annotations

from foldmill import Design, hookimpl
from foldmill_plugins.six_crease.generate import generate
from foldmill_plugins.six_crease.params import SixCreaseParams
from foldmill_plugins.six_crease.reports import REPORTS
from foldmill_plugins.six_crease.shapes import SHAPES

DESIGN = Design(
    slug="six-crease",
    title="Axisymmetric tube of six-crease bases",
    params=SixCreaseParams,
    generate=generate,
    presets=SHAPES,
    reports=REPORTS,
    references=("Y. Zhao, Design Methods for Triangle-based 3D Origami, chapter 5",),
)


@hookimpl
def foldmill_designs() -> list[Design[SixCreaseParams]]:
    """Offer the family."""
    return [DESIGN]
