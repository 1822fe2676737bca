"""What the operator is asked for at a gate, and which answers are refused.

An answer is judged here and nowhere else: a terminal, a web page and a script meet the same rules.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.materials import HalfCut, VScore
from foldmill_fabricate.passes import XY, Face, Gate, Plan, SetUp

ANOTHER_SHEET = 0.2
"""A sheet whose thickness differs by a larger share than this is another material."""
COLDEST, WARMEST = -20.0, 80.0
"""°C that a sheet in a workshop may have; beyond, another figure was typed."""
_LAID_ANEW = frozenset({"edge", "pins", "l-marks"})
"""Kinds of registration with which a sheet that was taken off comes back to where it lay."""


@dataclass(frozen=True)
class Request:
    """What the operator is asked for."""

    gate: Gate
    face: Face
    """The face that is up afterwards."""
    setup: SetUp
    plan: Plan
    sheet: str
    """The short id of the sheet that is worked on."""
    thickness: float | None = None
    """mm, as it was measured of this sheet before."""
    fitted: bool = False
    """Whether marks were measured on the sheet as it lies now."""
    picture: Path | None = None
    """A drawing of the flip, where there is one."""
    warning: str = ""
    """What is to be seen to first, a sentence; empty for nothing."""

    @property
    def needs_id(self) -> bool:
        """Whether the operator must read the id off the sheet."""
        return self.gate in {Gate.FLIP, Gate.RE_REGISTER}


@dataclass(frozen=True)
class Answer:
    """What the operator did and measured; None for what was not measured."""

    sheet: str = ""
    """The id that is written on the sheet."""
    thickness: float | None = None
    """mm"""
    temperature: float | None = None
    """°C of the sheet"""
    exposure: float | None = None
    """mm, where another was set than the plan's"""
    touched: bool = False
    """Whether the sheet was moved, or taken off, since it was last worked on."""
    marks: tuple[XY, ...] = field(default=())
    """Where registration marks are seen now, carrier coordinates in mm."""
    who: str = ""
    """By default whoever is at the computer."""

    @property
    def told(self) -> dict[str, Any]:
        """What is worth keeping."""
        measured = {"thickness": self.thickness, "temperature": self.temperature}
        measured |= {"exposure": self.exposure}
        kept: dict[str, Any] = {name: v for name, v in measured.items() if v is not None}
        if self.touched:
            kept["touched"] = True
        return kept | ({"marks": [list(mark) for mark in self.marks]} if self.marks else {})


def due(setup: SetUp, plan: Plan, *, returned: bool, begun: bool) -> tuple[Gate, ...]:
    """Return the gates before a set-up.

    returned : whether this sheet was worked on before somebody went away; begun : whether this very
    set-up was. What was measured and set then may have changed.
    """
    laid = [gate for gate in setup.gates if gate in {Gate.LOAD, Gate.FLIP}]
    if not (returned or begun):
        return setup.gates
    first = laid if laid and not begun else [Gate.RE_REGISTER]
    by_hand = plan.machine.tools.change == "operator"
    return (*first, Gate.TOOL) if by_hand else tuple(first)


def check(request: Request, answer: Answer) -> None:
    """Raise CannotSend, with the sentence, for an answer with which nothing may be cut."""
    named = answer.sheet.strip().upper()
    if (named or request.needs_id) and named != request.sheet:
        named = named or "none"
        raise CannotSend(
            f"The sheet on the machine is to be {request.sheet}, and the id that was read off it "
            f"is {named}. Take the sheet that says {request.sheet}, or send with --sheet for the "
            "other one."
        )
    if answer.thickness is not None or answer.exposure is not None:
        _check_depth(request, answer)
    if answer.temperature is not None and not COLDEST <= answer.temperature <= WARMEST:
        raise CannotSend(
            f"A sheet of {answer.temperature:g} °C is not believed; give °C between {COLDEST:g} "
            f"and {WARMEST:g}, or leave it out."
        )
    if answer.touched and not (answer.marks or request.fitted):
        _check_place(request)


def thickness_range(
    plan: Plan, setups: Sequence[SetUp] = (), exposure: float | None = None
) -> tuple[float, float]:
    """Return the least and greatest thickness, mm, that these set-ups can be made in.

    setups : by default all of the plan; exposure : what is set, mm, where it is not the plan's. A
    half-cut must be as deep, as a share of the sheet, as the material allows, and leave its web; a
    through-cut must come through.
    """
    material, machine = plan.material, plan.machine
    low = [material.thickness * (1 - ANOTHER_SHEET)]
    high = [material.thickness * (1 + ANOTHER_SHEET), machine.tools.max_thickness]
    every = setups or [setup for work in plan.passes for setup in work.setups]
    for setup in every if plan.coupon is None else ():
        depth = setup.exposure if exposure is None else exposure
        if setup.process == "cut":
            high += [depth] if material.cut.goes_through and depth else []
        elif depth and isinstance(material.score, HalfCut | VScore):
            low += [depth / material.score.depth_ratio_max, depth + material.score.web_min]
            high.append(depth / material.score.depth_ratio_min)
    return max(low), min(high)


def _check_depth(request: Request, answer: Answer) -> None:
    """Refuse a sheet too thin or too thick for the blade as it is set, and the other way round."""
    plan, known = request.plan, answer.thickness or request.thickness
    thickness = plan.material.thickness if known is None else known
    set_up = [request.setup] if answer.exposure is not None else []
    low, high = thickness_range(plan, set_up, answer.exposure)
    if low - 1e-9 <= thickness <= high + 1e-9 and isfinite(thickness):
        return
    short = low - thickness if thickness < low else thickness - high
    what = (
        f"With the blade {answer.exposure:g} mm out, {request.setup.name} can be made in sheets"
        if answer.exposure is not None
        else f"This job can be made in sheets of {plan.material.title}"
    )
    raise CannotSend(
        f"{what} from {low:.2f} to {high:.2f} mm thick, and this one has {thickness:g} mm: "
        f"{short:.2f} mm too {'thin' if thickness < low else 'thick'}. "
        + (
            "Set another exposure."
            if answer.exposure is not None
            else "Measure again, take another sheet, or plan with a preset of its own thickness."
        )
    )


def _check_place(request: Request) -> None:
    """Refuse to go on on a sheet that lies elsewhere, nobody knows where."""
    kind = request.plan.registration.kind
    if kind in _LAID_ANEW:
        return
    if request.face is Face.FRONT or kind == "none":
        raise CannotSend(
            f"Sheet {request.sheet} was moved while its {request.face} is half done, and nothing "
            f"brings that face back into register: what is left would land beside what is there. "
            f"Give it up with foldmill sheets {request.sheet} --spoiled, and begin another."
        )
    raise CannotSend(
        f"Sheet {request.sheet} was moved: measure its registration marks where they are now, with "
        "foldmill register or by hand, and give at least two of them."
    )
