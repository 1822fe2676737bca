"""What a person should know before cutting: geometry, depth, spacing, force. All as findings."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate.materials import CreaseWheel, HalfCut, Stylus, VScore
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.plan import relief, shapes, short, spacing

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


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
    if plan.machine.language != "hpgl":
        yield Finding(
            "no-programs",
            Severity.WARNING,
            plan.machine.slug,
            f"This machine speaks {plan.machine.language}, and programs in that language cannot be "
            f"written yet.",
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
    if isinstance(material.score, HalfCut | VScore | CreaseWheel | Stylus):
        yield from _depth_range(material.slug, material.score)


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
