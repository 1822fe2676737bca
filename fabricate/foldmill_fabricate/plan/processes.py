"""Which of a material's processes a machine can do, and the refusal where it can do none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.kinds import Kind
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material, Process, ThroughCut
from foldmill_fabricate.materials.processes import AnyCut, AnyScore

P = TypeVar("P", AnyScore, AnyCut)


def chosen(
    material: Material, machine: Machine, score: Kind | None = None, cut: Kind | None = None
) -> Material:
    """Return the material with the processes this machine makes its creases and outline by.

    score, cut : the processes to use; by default the first of the material's that the machine can
    do. Raises CannotPlan with what is missing, and what would work.
    """
    thickest = machine.tools.max_thickness
    if material.thickness > thickest:
        raise CannotPlan(
            f"{machine.slug} takes sheets up to {thickest:g} mm, and {material.title} is "
            f"{material.thickness:g} mm thick. Take a machine with more room or a thinner sheet."
        )
    scored = _first(material.scores, "scored", material, machine, score)
    parted = _first(material.cuts, "cut out", material, machine, cut)
    return material.model_copy(
        update={
            "score": scored,
            "other_scores": tuple(other for other in material.scores if other is not scored),
            "cut": parted,
            "other_cuts": tuple(other for other in material.cuts if other is not parted),
        }
    )


def _first(
    offered: Sequence[P], what: str, material: Material, machine: Machine, wanted: Kind | None
) -> P:
    known = [process.kind for process in offered]
    if wanted is not None and wanted not in known:
        raise CannotPlan(
            f"{material.title} cannot be {what} by {wanted}; its preset knows {', '.join(known)}."
        )
    tried = [process for process in offered if wanted in (None, process.kind)]
    reasons = {process.kind: lacking(process, machine) for process in tried}
    for process in tried:
        if not reasons[process.kind]:
            return process
    told = "; ".join(f"{kind}: {reason}" for kind, reason in reasons.items())
    others = [k for k in known if k not in reasons and k in machine.tools.stations]
    option = "--score" if what == "scored" else "--outline"
    instead = f"plan with {option} {' or '.join(others)}, or take" if others else "Take"
    wanting = " or ".join(_wants(process) for process in tried)
    raise CannotPlan(
        f"{material.title} cannot be {what} on {machine.slug}. {told}. "
        f"{instead[:1].upper()}{instead[1:]} a machine that offers {wanting}."
    )


def lacking(process: Process, machine: Machine) -> str:
    """Return what a machine lacks for a process; empty where it lacks nothing."""
    tools, kind = machine.tools, getattr(process, "kind", "")
    if kind not in tools.stations:
        return f"the machine does not offer it (it offers {', '.join(tools.stations)})"
    least = process.force_least if isinstance(process, ThroughCut) else process.force_needed
    if tools.max_force is not None and tools.max_force < least:
        return f"it takes {least:g} gf, and the machine has {tools.max_force:g} gf"
    return ""


def _wants(process: Process) -> str:
    kind = getattr(process, "kind", "")
    force = f" with {process.force_needed:g} gf" if process.force_needed else ""
    return f"{kind}{force}"
