"""Both proofs together, with their figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from foldmill import Assignment, CreasePattern
from foldmill.finding import Finding, Severity, has_errors
from foldmill_fabricate.passes import Face, Fit, Plan
from foldmill_fabricate.verify.asked import FACES, Asked
from foldmill_fabricate.verify.faults import Fault, drawn_faults, planned_faults
from foldmill_fabricate.verify.planned import planned
from foldmill_fabricate.verify.programs import ProgramProof, prove_programs
from foldmill_fabricate.verify.rule import prove_rule
from foldmill_fabricate.verify.virtual_sheet import Line, drawn_length

TOLD = frozenset({"remakes"})
"""Findings of the plan that are told here, though nothing is wrong: what was proved, and what not.
"""
MOST = 12
"""Findings of one kind that are told one by one; the rest are counted."""


@dataclass(frozen=True)
class Figures:
    """What was measured on the way. Lengths and deviations in mm."""

    programs: int
    strokes: int
    """strokes of the plan that programs were compared with"""
    deviation: float
    """largest distance between what is drawn and the plan"""
    tolerance: float
    """what is allowed"""
    drawn: Mapping[Face, float]
    """length with the tool down on each face, repeats and overcuts included"""
    creases: Mapping[Face, int]
    """creases of the pattern to be scored on each face"""
    mountains: int
    valleys: int
    flats: int
    ties: int
    holes: int
    copies: int = 1


@dataclass(frozen=True, eq=False)
class Verification:
    """What both proofs found. ``ok`` means that it may be sent."""

    title: str
    findings: tuple[Finding, ...]
    figures: Figures
    lines: tuple[Line, ...]
    """The virtual sheet: everything drawn, in order of work, in sheet coordinates."""
    faults: tuple[Fault, ...] = ()
    """The lines that are missing, extra or moved, for a picture."""
    is_derived: bool = True
    """Whether there was a pattern to prove the plan against."""

    @property
    def ok(self) -> bool:
        """Whether there is no finding of severity error."""
        return not has_errors(self.findings)


def verify(
    plan: Plan, pattern: CreasePattern, programs: Mapping[str, bytes], fit: Fit | None = None
) -> Verification:
    """Prove that the programs draw the plan, and that the plan is the pattern's.

    Errors that the plan itself reports (grooves that come too near) are findings here too.

    programs : bytes by file name, such as ``1-front-holes.hpgl``; what is not named like a program
    is left alone. fit : how a reverse lies whose programs were fitted to measured marks; those
    programs are not the recorded ones, so that only their drawing is compared.
    """
    proof = prove_programs(plan, programs, fit)
    own = [f for f in plan.findings if f.severity is Severity.ERROR or f.code in TOLD]
    findings = _digest([*own, *proof.findings, *prove_rule(plan, pattern)])
    lines = tuple(line for replay in proof.replays for line in replay.drawing.lines)
    figures = _figures(plan, pattern, proof, lines)
    faults = _faults(plan, pattern, proof) if has_errors(findings) else ()
    is_derived = plan.whole.source is None
    return Verification(plan.title, findings, figures, lines, faults, is_derived)


def _faults(plan: Plan, pattern: CreasePattern, proof: ProgramProof) -> tuple[Fault, ...]:
    drawn = [f for replay in proof.replays for f in drawn_faults(replay.drawing, replay.file.face)]
    if plan.coupon is not None or plan.whole.source is not None:
        return tuple(drawn)
    whole = plan.whole
    return (*drawn, *planned_faults(Asked(whole, pattern), planned(whole)))


def _digest(findings: Sequence[Finding]) -> tuple[Finding, ...]:
    """Keep the first of each kind, and count the rest."""
    kept: list[Finding] = []
    counts: dict[tuple[str, Severity], int] = {}
    for finding in findings:
        kind = (finding.code, finding.severity)
        counts[kind] = counts.get(kind, 0) + 1
        if counts[kind] <= MOST:
            kept.append(finding)
    for (code, severity), count in counts.items():
        if count > MOST:
            text = f"There are {count - MOST} more of this kind."
            kept.append(Finding(code, severity, "", text))
    return tuple(kept)


def _figures(
    plan: Plan, pattern: CreasePattern, proof: ProgramProof, lines: Sequence[Line]
) -> Figures:
    drawings = [replay.drawing for replay in proof.replays]
    faces = Asked(plan, pattern).score_face
    return Figures(
        programs=len(drawings),
        strokes=len(planned(plan)),
        deviation=max((drawing.deviation for drawing in drawings), default=0.0),
        tolerance=max((drawing.tolerance for drawing in drawings), default=0.0),
        drawn={face: drawn_length(line for line in lines if line.face is face) for face in FACES},
        creases={face: int((faces == k).sum()) for k, face in enumerate(FACES)},
        mountains=pattern.count(Assignment.M),
        valleys=pattern.count(Assignment.V),
        flats=pattern.count(Assignment.F),
        ties=len(plan.ties),
        holes=len(plan.holes),
        copies=1 + len(plan.copies),
    )
