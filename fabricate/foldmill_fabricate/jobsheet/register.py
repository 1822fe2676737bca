"""What the job sheet says about keeping the faces in register, by each kind; words and rows."""

from __future__ import annotations

from math import dist

from foldmill_fabricate.jobsheet.words import Row
from foldmill_fabricate.passes import Budget, Face, Mark, Plan, Stop
from foldmill_fabricate.sheet import NOMINAL, flipped, seen_by_machine

MARK_HEAD: Row = ("mark", "on the front", "after the flip", "after the flip, on the machine")
STOP_HEAD: Row = (
    "stop",
    "edge of the blank",
    "front pass, on the machine",
    "reverse pass, on the machine",
)
PIN_HEAD: Row = ("pin", "hole on the front", "after the flip, on the machine", "")


def heading(plan: Plan) -> str:
    """Return what keeps this job in register, as a heading."""
    made = plan.registration
    if made.kind == "pins":
        return f"Pins of {plan.holes[0].diameter:g} mm, {_spacing(plan):g} mm apart; mm"
    if made.kind == "holes" and plan.holes:
        wide = f"{plan.holes[0].diameter:g} mm wide"
        return f"Registration holes, {wide}; middles in mm from the lower left"
    return {
        "holes": "No registration holes: lay the sheet's edges against stops in both passes",
        "l-marks": "Registration marks for the machine's sensor; outer corners in mm",
        "edge": "Edge stops: push the blank against all three in each pass; mm",
        "none": "Nothing keeps the faces in register, as was asked for",
    }[made.kind]


def _spacing(plan: Plan) -> float:
    return round(dist(*plan.registration.pins), 3)


def table(plan: Plan) -> list[Row]:
    """Return the rows of places, the head first; none where there is nothing to place."""
    made = plan.registration
    if made.kind == "l-marks":
        return [MARK_HEAD, *(_mark_row(plan, k, mark) for k, mark in enumerate(made.marks, 1))]
    if made.kind == "edge":
        return [STOP_HEAD, *_stop_rows(made.stops)]
    if made.kind == "pins":
        return [PIN_HEAD, *_pin_rows(plan)]
    return []


def _stop_rows(stops: tuple[Stop, ...]) -> list[Row]:
    front, reverse = ([stop for stop in stops if stop.face is face] for face in Face)
    return [
        (
            str(k),
            one.edge if one.edge == two.edge else f"{one.edge}, then {two.edge}",
            *(f"{stop.x:.1f}, {stop.y:.1f}" for stop in (one, two)),
        )
        for k, (one, two) in enumerate(zip(front, reverse, strict=True), start=1)
    ]


def _mark_row(plan: Plan, number: int, mark: Mark) -> Row:
    corner = [(mark.x, mark.y)]
    turned = flipped(corner, plan.flip)[0]
    found = seen_by_machine(plan, Face.REVERSE, corner, NOMINAL)[0]
    name = f"{number} {'square' if mark.shape == 'square' else 'L'}"
    return (name, *(f"{x:.2f}, {y:.2f}" for x, y in (corner[0], turned, found)))


def _pin_rows(plan: Plan) -> list[Row]:
    spots = [(hole.x, hole.y) for hole in plan.holes]
    found = seen_by_machine(plan, Face.REVERSE, spots, NOMINAL)
    return [
        (str(k), f"{hole.x:.2f}, {hole.y:.2f}", f"{x:.2f}, {y:.2f}", "")
        for k, (hole, (x, y)) in enumerate(zip(plan.holes, found, strict=True), start=1)
    ]


def sentences(plan: Plan) -> list[str]:
    """Return what the operator does for this kind of registration, step by step."""
    made = plan.registration
    if made.kind == "l-marks":
        return [_about_marks(made.marks)]
    if made.kind == "edge":
        return [_about_edges(plan)]
    return [PINS] if made.kind == "pins" else []


def _about_edges(plan: Plan) -> str:
    size = f"{plan.sheet.width:g} × {plan.sheet.height:g} mm"
    left_right = plan.flip.kind == "left-right"
    moves = "left edge goes to the right" if left_right else "bottom edge goes to the top"
    return (
        f"The same two edges lie against stops in both passes: the {moves} with the flip, and its "
        f"stop with it. A blank that is not exactly {size} does no harm; one out of square does."
    )


PINS = (
    "Cut the front without pins. Then set the pins, turn the sheet over and press it down over "
    "them. Turned the wrong way it does not go on; not turned over at all it does, and the witness "
    "mark tells."
)


def _about_marks(marks: tuple[Mark, ...]) -> str:
    across, along = (
        max(side) - min(side) for side in zip(*((m.x, m.y) for m in marks), strict=True)
    )
    return (
        f"After the front pass push the cut marks out and stick matte dark tape over them on the "
        f"front face; on a dark or shiny sheet, matte white tape round them on the reverse. After "
        f"the flip let the machine search: its marks are {across:g} mm apart across and {along:g} "
        f"mm along. What it finds it makes up for itself."
    )


def budget_table(budget: Budget) -> tuple[Row, Row]:
    """Return the error budget: names of the shares and of their sums, and mm."""
    names = (*(share.name for share in budget.shares), "likely", "at worst", "half the sheet")
    errors = (*(share.error for share in budget.shares), budget.likely, budget.worst)
    return names, (*(f"± {error:.2f}" for error in errors), f"{budget.limit:g}")


def budget_words(budget: Budget) -> str:
    """Return how its shares come about."""
    return "; ".join(f"{share.name}: {share.because}" for share in budget.shares[:2]) + "."
