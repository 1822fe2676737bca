"""Axisymmetric tubes of generic six-crease bases (thesis chapter 5)."""

from __future__ import annotations

from dataclasses import replace

from foldmill import Design, hookimpl
from foldmill.axisymmetric.many import batch_of
from foldmill_plugins.six_crease.batch import prepare
from foldmill_plugins.six_crease.generate import generate
from foldmill_plugins.six_crease.params import SixCreaseParams
from foldmill_plugins.six_crease.reports import REPORTS
from foldmill_plugins.six_crease.shapes import SHAPES

_DESIGN = Design(
    slug="six-crease",
    title="Axisymmetric tube of six-crease bases",
    params=SixCreaseParams,
    generate=generate,
    presets=SHAPES,
    reports=REPORTS,
    references=("Y. Zhao, Design Methods for Triangle-based 3D Origami, chapter 5",),
)
DESIGN = replace(_DESIGN, batch=batch_of(_DESIGN, prepare))


@hookimpl
def foldmill_designs() -> list[Design[SixCreaseParams]]:
    """Offer the family."""
    return [DESIGN]
