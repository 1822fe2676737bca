"""What a person should know before cutting: geometry, depth, spacing, force. All as findings."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate.materials import (
    CreaseWheel,
    HalfCut,
    Material,
    Perforation,
    ScoreAndSnap,
    Stylus,
    ThroughCut,
    VScore,
)
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.plan import relief, shapes, short, spacing
from foldmill_fabricate.writers import writer

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

BLADE_STEP = 0.1
"""mm. Blades are set in such steps: half of one is the least that is sure to go through."""


def judge(
    pattern: CreasePattern,
    spots: Floats,
    by_face: dict[Face, Indices],
    stops: Mapping[int, float],
    relieved: Collection[int],
    plan: Plan,
) -> tuple[Finding, ...]:
    """Return the findings of a plan.

    spots : (V, 2) the vertices on the sheet, mm; stops : vertices that scores stop short of, and by
    how many mm; relieved : those with a relief hole.
    """
    return (
        *_material(plan),
        *_language(plan),
        *_force(plan),
        *_depth(plan),
        *short.findings(pattern, spots, by_face, stops, plan.material),
        *spacing.findings(pattern, spots, by_face, stops, plan.material, relieved),
        *relief.findings(plan.reliefs, pattern, spots),
        *shapes.findings(pattern, spots, plan),
    )


def _material(plan: Plan) -> Iterator[Finding]:
    if not plan.material.tested:
        yield Finding(
            "untested-material",
            Severity.WARNING,
            plan.material.slug,
            "The values for this material are untested.",
            "Try depth and folding on a piece of waste first.",
        )
    if not plan.machine.verified:
        yield Finding(
            "unverified-machine",
            Severity.INFO,
            plan.machine.slug,
            "This machine's profile was not verified on hardware.",
            "Run the first job with the tool up.",
        )


def _language(plan: Plan) -> Iterator[Finding]:
    if writer(plan.machine) is None:
        yield Finding(
            "no-programs",
            Severity.WARNING,
            plan.machine.slug,
            f"This machine speaks {plan.machine.language}, and nothing installed writes programs "
            f"in that language.",
            "Open the drawings in the machine's own software, one face after the other.",
        )


def _force(plan: Plan) -> Iterator[Finding]:
    cut, tools = plan.material.cut, plan.machine.tools
    if tools.max_force is None:
        yield Finding(
            "power-by-trial",
            Severity.INFO,
            plan.machine.slug,
            "This machine sets no force, and no table of its power and speed is known.",
            "Find both on waste: lines that are to go through must fall out by themselves.",
        )
        return
    if tools.max_force < cut.force_needed:
        yield Finding(
            "through-cut-marginal",
            Severity.WARNING,
            plan.machine.slug,
            f"{plan.material.title} needs {cut.force_needed:g} gf to be cut through, and this "
            f"machine has {tools.max_force:g} gf: it may not get through in {cut.repeats} repeats.",
            "Snap the outline along its groove, or finish it with a hand knife and a ruler.",
        )
    if tools.max_force < plan.material.score.force:
        yield Finding(
            "score-force",
            Severity.WARNING,
            plan.machine.slug,
            f"Scoring is set to {tools.max_force:g} gf, all this machine has; "
            f"{plan.material.score.force:g} gf are usual.",
            "Try one more repeat on waste.",
        )
    for process in (plan.material.score, cut):
        if process.force < min(process.force_needed, tools.max_force):
            yield Finding(
                "force-low",
                Severity.WARNING,
                plan.material.slug,
                f"The {process.title} is set to {process.force:g} gf and needs "
                f"{process.force_needed:g} gf; this machine has {tools.max_force:g} gf.",
                f"Raise {process.kind}.force in the preset.",
            )


def _depth(plan: Plan) -> Iterator[Finding]:
    material = plan.material
    if material.web < material.score.web_min:
        yield Finding(
            "web-too-thin",
            Severity.ERROR,
            material.slug,
            f"The groove leaves a web of {material.web:.2f} mm, and {material.score.web_min:g} mm "
            f"are needed.",
            "Lower the depth ratio.",
        )
    if isinstance(material.score, HalfCut | VScore) and material.score.exposure:
        yield from _blade(material, material.score)
    yield from _through(plan)
    if isinstance(material.score, HalfCut | VScore | CreaseWheel | Stylus):
        yield from _depth_range(material.slug, material.score)


def _blade(material: Material, score: HalfCut | VScore) -> Iterator[Finding]:
    """Judge how far the blade stands out: it makes the depth that the preset's share promises."""
    wanted = score.depth_ratio * material.thickness
    left = max(0.0, material.thickness - score.exposure)
    too_deep = left < score.web_min - 1e-9
    if not too_deep and abs(score.exposure - wanted) <= BLADE_STEP / 2 + 1e-9:
        return
    yield Finding(
        "blade-depth",
        Severity.ERROR if too_deep else Severity.WARNING,
        material.slug,
        f"The blade of the {score.title} stands out {score.exposure:g} mm and leaves {left:.2f} mm "
        f"of the sheet; a depth of {score.depth_ratio:.0%} leaves "
        f"{material.thickness - wanted:.2f} mm, and {score.web_min:g} mm are needed.",
        f"Set {score.kind}.exposure to {wanted:.2f} mm, or depth_ratio to what you mean.",
    )


def _through(plan: Plan) -> Iterator[Finding]:
    """Judge what is to go through the sheet, or is to leave so much that it snaps."""
    material, cut = plan.material, plan.material.cut
    for process in (material.score, cut):
        spare = process.exposure - material.thickness
        if isinstance(process, Perforation | ThroughCut) and spare < BLADE_STEP / 2 - 1e-9:
            yield Finding(
                "through-cut-shallow",
                Severity.WARNING,
                material.slug,
                f"The blade of the {process.title} stands out {process.exposure:g} mm for a sheet "
                f"of {material.thickness:g} mm; a worn tip or an uneven mat leaves "
                f"{max(0.0, BLADE_STEP / 2 - spare):.2f} mm standing.",
                f"Set {process.kind}.exposure to {material.thickness + BLADE_STEP:.2f} mm or more.",
            )
    if isinstance(cut, ScoreAndSnap):
        left = material.thickness - cut.exposure
        if abs(left - cut.web) > BLADE_STEP / 2 + 1e-9:
            yield Finding(
                "snap-web",
                Severity.WARNING,
                material.slug,
                f"The blade leaves {left:.2f} mm of the sheet under the outline; {cut.web:g} mm "
                f"snap off cleanly.",
                f"Set {cut.kind}.exposure to {material.thickness - cut.web:.2f} mm.",
            )


def _depth_range(slug: str, score: HalfCut | VScore | CreaseWheel | Stylus) -> Iterator[Finding]:
    low, high = score.depth_ratio_min, score.depth_ratio_max
    if not low <= score.depth_ratio <= high:
        deep = score.depth_ratio > high
        yield Finding(
            "depth-range",
            Severity.WARNING,
            slug,
            f"The {score.title} goes {score.depth_ratio:.0%} into the sheet; {low:.0%} to "
            f"{high:.0%} are usual. {'The fold may tear' if deep else 'The fold may wander'}.",
            f"Set depth_ratio to {(low + high) / 2:.2f}.",
        )
