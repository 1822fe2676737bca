"""What a person should know before cutting: geometry, depth, spacing, force. All as findings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.plan import spacing
from foldmill_fabricate.plan.scores import held_back

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

SHORT_CREASE = 2.0
"""mm of score that must remain between two setbacks: less does not guide a fold."""


def refuse_short_creases(
    pattern: CreasePattern, by_face: dict[Face, Indices], stops: set[int], setback: float
) -> None:
    """Raise CannotPlan for a crease that its setbacks would swallow."""
    for edge in np.concatenate(list(by_face.values())).tolist():
        taken = setback * sum(int(v) in stops for v in pattern.edges[edge])
        if pattern.edge_lengths[edge] <= taken:
            raise CannotPlan(
                f"Crease {edge} is {pattern.edge_lengths[edge]:.2f} mm long, and scores stop "
                f"{setback:g} mm short of the vertices at its ends: nothing is left to score. "
                f"Enlarge the design or merge its vertices."
            )


def judge(
    pattern: CreasePattern,
    spots: Floats,
    by_face: dict[Face, Indices],
    plan: Plan,
) -> tuple[Finding, ...]:
    """Return the findings of a plan; spots : (V, 2) the vertices on the sheet, mm."""
    stops = held_back(pattern, by_face)
    return (
        *_material(plan),
        *_force(plan),
        *_depth(plan),
        *_short_creases(pattern, spots, by_face, stops, plan),
        *spacing.findings(pattern, spots, by_face, stops, plan.material),
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


def _force(plan: Plan) -> Iterator[Finding]:
    cut, tools = plan.material.cut, plan.machine.tools
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
            Severity.ERROR,
            plan.machine.slug,
            f"Scoring needs {plan.material.score.force:g} gf, and this machine has "
            f"{tools.max_force:g} gf.",
            "Take another machine, or a material that scores with less force.",
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


def _short_creases(
    pattern: CreasePattern,
    spots: Floats,
    by_face: dict[Face, Indices],
    stops: set[int],
    plan: Plan,
) -> Iterator[Finding]:
    score, least = plan.material.score, plan.material.min_feature
    for face, edges in by_face.items():
        for edge in edges.tolist():
            length = float(pattern.edge_lengths[edge])
            taken = score.setback * sum(int(v) in stops for v in pattern.edges[edge])
            x, y = spots[pattern.edges[edge]].mean(axis=0)
            if length < max(taken + SHORT_CREASE, least):
                yield Finding(
                    "short-crease",
                    Severity.WARNING,
                    f"crease {edge} on the {face} at ({x:.1f}, {y:.1f}) mm",
                    f"It is {length:.2f} mm long, of which {length - taken:.2f} mm are scored.",
                    "Fold it by hand along a ruler, or enlarge the design.",
                )
