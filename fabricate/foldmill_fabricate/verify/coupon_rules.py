"""What a coupon declares makes sense: ladders a person can read, and figures that are allowed."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from foldmill.finding import Finding, Severity
from foldmill_fabricate.ladders import Coupon, Ladder, Rung, Vernier
from foldmill_fabricate.materials import Perforation
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.coupon_cells import RUN_ON, WORDS_UNDER
from foldmill_fabricate.verify.forces import settable

PITCHES = (10.0, 10.1)
"""mm between a vernier's lines: a tenth of a millimetre shows as one line."""
NEAR = 8.0
"""mm within which a rung's value stands below it."""

Box = tuple[float, float, float, float]


def prove_declared(plan: Plan, coupon: Coupon) -> list[Finding]:
    """Check what is declared by itself."""
    found = [finding for ladder in coupon.ladders for finding in _ladder(plan, coupon, ladder)]
    found += [finding for v in coupon.verniers for finding in _vernier(coupon, v)]
    axes = {vernier.axis for vernier in coupon.verniers}
    found += [
        _error("coupon-vernier", f"vernier {axis}", "There is none along this axis.")
        for axis in ("x", "y")
        if axis not in axes
    ]
    return [*found, *_lettering(plan, coupon), *_room(plan, coupon)]


def _error(code: str, where: str, message: str) -> Finding:
    return Finding(code, Severity.ERROR, where, message, "Make the coupon again.")


def _ladder(plan: Plan, coupon: Coupon, ladder: Ladder) -> Iterator[Finding]:
    where = f"{ladder.kind} ladder"
    for rung in ladder.rungs:
        wrong = _refused(plan, ladder, rung)
        if wrong:
            yield _error("coupon-rung", f"{ladder.kind} rung {rung.value:g}", wrong)
        if coupon.words and not _is_labelled(coupon, rung):
            text = f"No {rung.value:g} stands below it on the {rung.face}."
            yield _error("coupon-label", f"{ladder.kind} rung {rung.value:g}", text)
    rungs = [(rung.value, rung.face) for rung in ladder.rungs]
    if len(set(rungs)) < len(rungs):
        yield _error("coupon-rung", where, "Two of its rungs try the same.")
    now = _usual(plan, ladder)
    if now is not None and all(abs(value - now) > tolerances.PLAN_MM for value, _ in rungs):
        yield _error("coupon-rung", where, f"The preset's own {now:g} is not among its rungs.")


def _usual(plan: Plan, ladder: Ladder) -> float | None:
    score = plan.material.score
    return {
        "depth": score.exposure,
        "force": settable(score.force, plan.machine.tools),
        "repeats": float(score.repeats),
        "gap": score.gap if isinstance(score, Perforation) else None,
        "spacing": score.min_spacing,
    }.get(ladder.kind)


def _refused(plan: Plan, ladder: Ladder, rung: Rung) -> str:
    """Return why a rung's value must not be tried; empty where it may."""
    score, value = plan.material.score, rung.value
    deepest = plan.material.thickness - score.web_min
    weakest, strongest = plan.machine.tools.min_force, plan.machine.tools.max_force or 0.0
    if ladder.kind == "depth" and not 0 < value <= deepest + tolerances.PLAN_MM:
        return f"The blade would leave less than the web; {deepest:g} mm is the most."
    if ladder.kind == "force" and not max(weakest, 1e-9) <= value <= strongest:
        return f"The machine sets {weakest:g} to {strongest:g} gf."
    if ladder.kind == "repeats" and value not in range(1, 21):
        return "It is no number of times, 1 to 20."
    if ladder.kind == "gap" and not (isinstance(score, Perforation) and 0 < value < 10):
        return "Only rows of cuts have lands, and these must leave some on a strip."
    if ladder.kind == "spacing" and not 0 < value < 30:
        return "Two scores cannot lie so on one strip."
    if ladder.kind == "hinge" and value not in (90, 180):
        return "Hinges are folded by 90° or 180°."
    if ladder.kind == "relief" and value and not 1.5 <= value <= 20:
        return "A knife makes no such hole: 1.5 to 20 mm."
    return ""


def _is_labelled(coupon: Coupon, rung: Rung) -> bool:
    """Tell whether a rung's value, and no other, stands in the strip below its cuts."""
    x, y = rung.at
    wide = coupon.strip_width
    below = [
        words.text
        for words in coupon.words
        if words.face == rung.face
        and x - tolerances.PLAN_MM <= words.at[0] <= x + coupon.patch
        and y - tolerances.PLAN_MM <= words.at[1] <= y + WORDS_UNDER
        and min(abs(words.at[0] - x), abs(words.at[0] - x - wide), abs(words.at[0] - x - 40)) < NEAR
    ]
    return f"{rung.value:g}" in below


def _vernier(coupon: Coupon, vernier: Vernier) -> Iterator[Finding]:
    where = f"vernier {vernier.axis} at shift {vernier.shift:g} mm"
    if (vernier.front_pitch, vernier.reverse_pitch) != PITCHES:
        text = f"Its lines are {vernier.front_pitch:g} and {vernier.reverse_pitch:g} mm apart; "
        yield _error("coupon-vernier", where, f"{text}they read tenths at 10 and 10.1 mm.")
    if coupon.words:
        yield from _numbers(coupon, vernier, where)


def _numbers(coupon: Coupon, vernier: Vernier, where: str) -> Iterator[Finding]:
    """Check that the numbers at a vernier's lines say what meets there."""
    axis, n = (0 if vernier.axis == "x" else 1), vernier.each_way
    right = {k: str(-round(10 * vernier.shift) - k) for k in range(-n, n + 1)}
    seen = 0
    for words in coupon.words:
        beside = words.at[1 - axis] - vernier.at[1 - axis]
        wide = len(words.text) * words.height if axis == 0 else words.height
        along = words.at[axis] + wide / 2 - vernier.at[axis]
        k = round(along / vernier.front_pitch)
        near = vernier.tick < beside < vernier.tick + 3 and abs(along - 10 * k) < 2
        if words.face != "front" or not near or k not in right:
            continue
        seen += 1
        if words.text != right[k]:
            text = f"The number at line {k} says {words.text}; {right[k]} tenths meet there."
            yield _error("coupon-number", where, text)
    if seen < 3:
        yield _error("coupon-number", where, f"{seen} numbers stand at its lines; three at least.")


def _lettering(plan: Plan, coupon: Coupon) -> Iterator[Finding]:
    """Check that words are drawn by a process that the machine has, and that leaves the sheet."""
    how = coupon.lettering
    if coupon.words and how.process == "perforation":
        yield _error("coupon-words", "words", "They would go through the sheet.")
    offered: dict[str, int] = {str(kind): n for kind, n in plan.machine.tools.stations.items()}
    if offered.get(how.process) != how.tool:
        text = f"They are drawn by {how.process} with tool {how.tool}, which the machine has not."
        yield _error("coupon-words", "words", text)
    deepest = plan.material.thickness - plan.material.score.web_min
    if coupon.words and how.exposure > deepest + tolerances.PLAN_MM:
        yield _error("coupon-words", "words", f"They go deeper than {deepest:g} mm.")


def _room(plan: Plan, coupon: Coupon) -> Iterator[Finding]:
    """Check that cells neither overlap nor touch, and lie on the blank."""
    boxes = [
        (f"{ladder.kind} rung {rung.value:g}", _box(coupon, ladder, rung))
        for ladder in coupon.ladders
        for rung in ladder.rungs
    ]
    for (one, a), (other, b) in combinations(boxes, 2):
        if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]:
            yield _error("coupon-overlap", one, f"Its cell and that of {other} overlap.")
    for name, box in boxes:
        inside = box[0] >= 0 and box[1] >= 0
        if not (inside and box[2] <= plan.sheet.width and box[3] <= plan.sheet.height):
            yield _error("coupon-overlap", name, "Its cell is not on the blank.")


def _box(coupon: Coupon, ladder: Ladder, rung: Rung) -> Box:
    wide, high = coupon.strip_width, WORDS_UNDER + RUN_ON + coupon.strip_length
    if ladder.kind == "relief":
        wide, high = coupon.patch, WORDS_UNDER + coupon.patch
    return rung.at[0], rung.at[1], rung.at[0] + wide, rung.at[1] + high
