"""Axisymmetric forms edited in space, their surplus paper tucked away (thesis chapter 4)."""

from __future__ import annotations

from foldmill import Design, hookimpl
from foldmill_plugins.tuck.cups import CUPS
from foldmill_plugins.tuck.generate import generate
from foldmill_plugins.tuck.params import TuckParams
from foldmill_plugins.tuck.stools import STOOLS

DESIGN = Design(
    slug="tuck",
    title="Axisymmetric form with tucks",
    params=TuckParams,
    generate=generate,
    presets={**STOOLS, **CUPS},
    references=("Y. Zhao, Design Methods for Triangle-based 3D Origami, chapter 4",),
)


@hookimpl
def foldmill_designs() -> list[Design[TuckParams]]:
    """Offer the family."""
    return [DESIGN]
