"""Waterbomb tessellations on target surfaces (thesis chapter 6)."""

from __future__ import annotations

from foldmill import Design, hookimpl
from foldmill_plugins.waterbomb import closeness, convergence, crimp, density, feasibility, nearer
from foldmill_plugins.waterbomb.generate import generate
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.presets import PRESETS
from foldmill_plugins.waterbomb.stages import stages

DESIGN = Design(
    slug="waterbomb",
    title="Waterbomb tessellation on a target surface",
    params=WaterbombParams,
    generate=generate,
    presets=PRESETS,
    reports={
        "feasibility": feasibility.report,
        "convergence": convergence.report,
        "closeness": closeness.report,
        "density": density.report,
        "fit": nearer.report,
        "foldability": crimp.report,
    },
    stages=stages,
    references=("Y. Zhao, Design Methods for Triangle-based 3D Origami, chapter 6",),
)


@hookimpl
def foldmill_designs() -> list[Design[WaterbombParams]]:
    """Offer the family."""
    return [DESIGN]
