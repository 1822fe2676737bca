"""Which trials each ladder has: values around the preset's, or a sentence why there are none."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from foldmill_fabricate.ladders import LadderKind
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material, PenLine, Perforation
from foldmill_fabricate.plan.relief import SMALLEST, diameter
from foldmill_fabricate.writers import writer

Values = tuple[float, ...]

STEPS = ((0.6, 0.1), (0.3, 0.05), (0.0, 0.025))
"""mm. From which thickness on the blade is tried in which steps; holders click every 0.1 mm."""
FORCES = (0.6, 0.8, 1.0, 1.2, 1.4)
"""Shares of the force the preset sets."""
GAPS = (0.5, 0.75, 1.0, 1.5, 2.0)
"""Shares of the land that the preset leaves between two cuts of a perforation."""
SPACINGS = (2.0, 1.5, 1.0, 0.75, 0.5)
"""Shares of the least distance that the preset allows."""
RELIEFS = (-0.5, 0.0, 0.5, 1.0)
"""mm beside the diameter that the rule gives."""
ANGLES = (90.0, 180.0)
"""deg to which hinges are folded."""


def trials(
    material: Material, machine: Machine, degree: int
) -> tuple[dict[LadderKind, Values], tuple[str, ...]]:
    """Return the values of each ladder that means something here, and sentences on the others."""
    asked: dict[LadderKind, Callable[[], Values | str]] = {
        "depth": lambda: _depths(material, machine),
        "force": lambda: _forces(material, machine),
        "repeats": lambda: _repeats(material, machine),
        "gap": lambda: _gaps(material),
        "spacing": lambda: _spacings(material),
        "hinge": lambda: ANGLES,
        "relief": lambda: _reliefs(material, degree),
    }
    if not isinstance(material.score, Perforation):
        del asked["gap"]
    found = {kind: ask() for kind, ask in asked.items()}
    values = {kind: each for kind, each in found.items() if not isinstance(each, str)}
    return values, tuple(each for each in found.values() if isinstance(each, str))


def _sorted(values: Iterable[float]) -> Values:
    return tuple(sorted({round(value, 3) for value in values}))


def _depths(material: Material, machine: Machine) -> Values | str:
    score = material.score
    if isinstance(score, Perforation):
        return "The depth ladder is left out: a perforation goes through the sheet in any case."
    if not score.exposure:
        return f"The depth ladder is left out: {score.title} has no blade; its force makes depth."
    if machine.tools.change == "select":
        return (
            f"The depth ladder is left out: {machine.slug} works through a whole face without a "
            f"stop, so that nobody can set the blade between two rungs."
        )
    if writer(machine) is None:
        return _no_programs("depth", machine)
    step = next(step for thickness, step in STEPS if material.thickness >= thickness)
    most = material.thickness - score.web_min
    tried = (score.exposure + k * step for k in range(-2, 3))
    return _sorted(value for value in tried if step / 2 < value <= most + 1e-9)


def _forces(material: Material, machine: Machine) -> Values | str:
    score, tools = material.score, machine.tools
    if isinstance(score, PenLine):
        return "The force ladder is left out: a pen's line is creased by hand."
    if tools.max_force is None or not machine.dialect.force:
        return f"The force ladder is left out: {machine.slug} sets no force from a program."
    if writer(machine) is None:
        return _no_programs("force", machine)
    set_now = tools.force(score.force)
    least, grain = max(1.0, tools.min_force), 5.0 if set_now >= 50 else 1.0
    tried = [grain * round(share * set_now / grain) for share in FORCES if share != 1.0]
    return _sorted([set_now, *(f for f in tried if least <= f <= tools.max_force)])


def _repeats(material: Material, machine: Machine) -> Values | str:
    now = material.score.repeats
    if isinstance(material.score, PenLine):
        return "The repeats ladder is left out: a pen's line is creased by hand."
    if writer(machine) is None:
        return _no_programs("repeats", machine)
    return _sorted(float(n) for n in range(max(1, now - 2), min(20, now + 2) + 1))


def _no_programs(ladder: str, machine: Machine) -> str:
    return (
        f"The {ladder} ladder is left out: {machine.slug} works from drawings, and its own "
        f"software sets one figure for a whole layer."
    )


def _gaps(material: Material) -> Values:
    """Return lands between the cuts of a row, mm; the cuts stay as long as they are."""
    assert isinstance(material.score, Perforation)
    now = material.score.gap
    return _sorted([now, *(round(share * now, 1) for share in GAPS if share != 1.0)])


def _spacings(material: Material) -> Values | str:
    least = material.score.min_spacing
    if isinstance(material.score, PenLine):
        return "The spacing ladder is left out: a pen's line is creased by hand."
    return _sorted([least, *(round(share * least, 1) for share in SPACINGS if share != 1.0)])


def _reliefs(material: Material, degree: int) -> Values | str:
    if not material.cut.goes_through:
        return f"The relief ladder is left out: {material.cut.title} makes no holes."
    right = diameter(degree, material)
    return _sorted([0.0, right, *(right + d for d in RELIEFS if right + d >= SMALLEST)])
