"""What became of a tessellation: four ways to fail, each told by itself; none of them is "ok".

*Not converged*: no developable form was found. *Wrong-signed*: a crease folds against the pattern
of a waterbomb. *Self-intersecting*: facets pass through each other. *Overlapping*: the flat sheet
lies upon itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from foldmill import Assignment, CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_plugins.waterbomb.topology import Codes


@dataclass(frozen=True)
class Status:
    """The four verdicts, each with its figure."""

    e_total_deg: float
    """Greatest deviation of an angle sum from 360°."""
    is_converged: bool
    wrong_signed: int
    """Creases that fold the other way than a waterbomb's, or not at all."""
    penetrations: int
    """Pairs of facets that pass through each other."""
    is_flat_simple: bool
    """Whether the outline of the flat sheet meets itself nowhere."""

    @property
    def verdicts(self) -> tuple[str, ...]:
        """Every failure by name; "ok" where there is none."""
        named = (
            ("not-converged", not self.is_converged),
            ("wrong-signed", self.wrong_signed > 0),
            ("self-intersecting", self.penetrations > 0),
            ("flat-overlap", not self.is_flat_simple),
        )
        return tuple(name for name, failed in named if failed) or ("ok",)

    def said(self) -> dict[str, Any]:
        """Return the verdicts in one text, as they travel with a file."""
        return {"verdict": ", ".join(self.verdicts)}

    def facts(self) -> dict[str, Any]:
        """Return verdicts and figures, for files and people."""
        return {"verdicts": list(self.verdicts), **vars(self)}


def wrong_signed(pattern: CreasePattern, wanted: Codes) -> list[int]:
    """Return the creases (edges) whose assignment is another than a waterbomb's, wanted (E,)."""
    return [int(edge) for edge in (pattern.assignments != wanted).nonzero()[0]]


def findings(pattern: CreasePattern, wanted: Codes, state: Status) -> tuple[Finding, ...]:
    """Return what no general check can tell as well: wrong signs, and a sheet upon itself."""
    return (*_signs(pattern, wanted), *overlap(state))


def through(state: Status) -> tuple[Finding, ...]:
    """Return that the whole form passes through itself, which no single piece of it shows."""
    if not state.penetrations:
        return ()
    finding = Finding(
        "penetration",
        Severity.ERROR,
        "the whole form",
        f"Put together, the form passes through itself: {state.penetrations} pairs of facets.",
        "Choose other parameters; no sheets can be put together like this.",
    )
    return (finding,)


def overlap(state: Status) -> tuple[Finding, ...]:
    """Return that the sheet lies upon itself, where it does."""
    if state.is_flat_simple:
        return ()
    finding = Finding(
        "flat-overlap",
        Severity.ERROR,
        "outline",
        "The form is developable, but laid flat its sheet lies upon itself.",
        "Cut it into pieces by --pieces.auto true, or take another depth.",
    )
    return (finding,)


def _signs(pattern: CreasePattern, wanted: Codes) -> tuple[Finding, ...]:
    wrong = wrong_signed(pattern, wanted)
    if not wrong:
        return ()
    first = wrong[0]
    x, y = pattern.vertices[pattern.edges[first]].mean(axis=0)
    names = {Assignment.M: "mountain", Assignment.V: "valley"}
    is_one = len(wrong) == 1
    finding = Finding(
        "crease-sign",
        Severity.ERROR,
        f"edge {first} at ({x:.3f}, {y:.3f}) mm",
        f"{len(wrong)} of {len(pattern.edges)} edges {'folds' if is_one else 'fold'} otherwise "
        f"than in a waterbomb tessellation; this one should be a "
        f"{names[Assignment(wanted[first])]} and folds by {pattern.fold_angles[first]:.3g}°.",
        "Take another depth, or another n_u and n_v, so that cells are more nearly square.",
    )
    return (finding,)
