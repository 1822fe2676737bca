"""The stool and the demo machines, made once per test process."""

from __future__ import annotations

from functools import cache

from foldmill import Fold, installed
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material, ThroughCut
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make

ONE_TOOL = "generic-hpgl-600"
PENS = "generic-hpgl-pens"


@cache
def stool(preset: str = "stool-n8") -> Fold:
    design = installed().design("tuck")
    return design.run(design.preset(preset))


def material() -> Material:
    found: Material = installed().get("foldmill_materials", "material", "pp-0.75")
    return found


def through_cut(of: Material) -> ThroughCut:
    """Return how the material is cut through; the outline must be made so."""
    assert isinstance(of.cut, ThroughCut)
    return of.cut


def machine(slug: str = ONE_TOOL) -> Machine:
    found: Machine = installed().get("foldmill_machines", "machine", slug)
    return found


@cache
def stool_plan(slug: str = ONE_TOOL) -> Plan:
    return make(stool(), material(), machine(slug))
