"""Ways in which good coupons go wrong, each with the code of the finding that must name it.

What is changed is the plan: its declared ladders, or what it draws. Programs are written anew.
"""

from __future__ import annotations

from collections.abc import Callable

from coupons import declared

from foldmill_fabricate.coupon import lettering
from foldmill_fabricate.ladders import Ladder
from foldmill_fabricate.passes import Operation, Plan, Role, SetUp, Stroke

Change = Callable[[Plan], Plan]


def _with(plan: Plan, **changes: object) -> Plan:
    return plan.model_copy(update={"coupon": declared(plan).model_copy(update=changes)})


def _ladders(plan: Plan, change: Callable[[Ladder], Ladder]) -> Plan:
    return _with(plan, ladders=tuple(change(ladder) for ladder in declared(plan).ladders))


def _rung(kind: str, index: int, **changes: object) -> Change:
    def change(ladder: Ladder) -> Ladder:
        if ladder.kind != kind:
            return ladder
        rungs = list(ladder.rungs)
        rungs[index] = rungs[index].model_copy(update=changes)
        return ladder.model_copy(update={"rungs": tuple(rungs)})

    return lambda plan: _ladders(plan, change)


def _vernier(**changes: object) -> Change:
    def change(plan: Plan) -> Plan:
        first, *rest = declared(plan).verniers
        return _with(plan, verniers=(first.model_copy(update=changes), *rest))

    return change


def _setups(plan: Plan, change: Callable[[SetUp], SetUp]) -> Plan:
    passes = tuple(
        work.model_copy(update={"setups": tuple(change(setup) for setup in work.setups)})
        for work in plan.passes
    )
    return plan.model_copy(update={"passes": passes})


def _operations(role: Role, change: Callable[[Operation], Operation]) -> Change:
    def edit(setup: SetUp) -> SetUp:
        found = tuple(change(op) if op.role is role else op for op in setup.operations)
        return setup.model_copy(update={"operations": found})

    return lambda plan: _setups(plan, edit)


def _strokes(role: Role, change: Callable[[tuple[Stroke, ...]], tuple[Stroke, ...]]) -> Change:
    return _operations(role, lambda op: op.model_copy(update={"strokes": change(op.strokes)}))


def _moved(stroke: Stroke, dx: float, dy: float) -> Stroke:
    return Stroke(points=tuple((x + dx, y + dy) for x, y in stroke.points))


def _mirrored(stroke: Stroke, both: float) -> Stroke:
    return Stroke(points=tuple((both - x, y) for x, y in stroke.points))


def _first_moved(dx: float, dy: float) -> Callable[[tuple[Stroke, ...]], tuple[Stroke, ...]]:
    return lambda strokes: (_moved(strokes[0], dx, dy), *strokes[1:])


def _setup(name: str, **changes: object) -> Change:
    def edit(setup: SetUp) -> SetUp:
        return setup.model_copy(update=changes) if setup.name == name else setup

    return lambda plan: _setups(plan, edit)


def reverse_words_are_mirrored(plan: Plan) -> Plan:
    """As a writer would do who mirrors text with the sheet: the heading, about its own middle."""
    heading = next(w for w in declared(plan).words if w.text.startswith("REVERSE"))
    low, both = heading.at[1], 2 * heading.at[0] - lettering.width(heading.text, heading.height)

    def mirrored(strokes: tuple[Stroke, ...]) -> tuple[Stroke, ...]:
        return tuple(
            _mirrored(s, both) if all(low <= y <= low + heading.height for _, y in s.points) else s
            for s in strokes
        )

    def edit(setup: SetUp) -> SetUp:
        if setup.name != "reverse-words":
            return setup
        operations = tuple(
            op.model_copy(update={"strokes": mirrored(op.strokes)}) for op in setup.operations
        )
        return setup.model_copy(update={"operations": operations})

    return _setups(plan, edit)


def two_rungs_change_places(plan: Plan) -> Plan:
    """The strips of 0.2 and 0.5 mm are made with each other's depth: the ladder reads backwards."""

    def edit(setup: SetUp) -> SetUp:
        swapped = {0.2: 0.5, 0.5: 0.2}
        if not setup.name.startswith("front-rung"):
            return setup
        return setup.model_copy(update={"exposure": swapped.get(setup.exposure, setup.exposure)})

    return _setups(plan, edit)


def a_word_says_another_depth(plan: Plan) -> Plan:
    words = tuple(
        word.model_copy(update={"text": "0.4"}) if word.text == "0.3" else word
        for word in declared(plan).words
    )
    return _with(plan, words=words)


def a_vernier_number_is_wrong(plan: Plan) -> Plan:
    words = tuple(
        word.model_copy(update={"text": "-45"}) if word.text == "-35" else word
        for word in declared(plan).words
    )
    return _with(plan, words=words)


def the_patches_have_no_ties(plan: Plan) -> Plan:
    return plan.model_copy(update={"ties": ()})


def a_vernier_is_missing(plan: Plan) -> Plan:
    return _with(plan, verniers=tuple(v for v in declared(plan).verniers if v.axis == "x"))


def the_bars_are_shorter_than_said(plan: Plan) -> Plan:
    bars = declared(plan).bars
    return _with(plan, bars=bars.model_copy(update={"width": bars.width - 1.0}))


def a_cell_lies_on_another(plan: Plan) -> Plan:
    coupon = declared(plan)
    return _rung("depth", 1, at=coupon.ladders[0].rungs[0].at)(plan)


CORRUPTIONS: dict[str, tuple[Change, str]] = {
    "a strip is not scored": (_strokes(Role.SCORE, lambda s: s[1:]), "coupon-missing"),
    "a strip is scored twice": (_strokes(Role.SCORE, lambda s: (*s, s[0])), "coupon-stray"),
    "a score is moved": (_strokes(Role.SCORE, _first_moved(0, 0.2)), "coupon-missing"),
    "a strip is not cut free": (_strokes(Role.CUT_INNER, lambda s: s[1:]), "coupon-missing"),
    "a hole is missing": (_strokes(Role.RELIEF, lambda s: s[1:]), "coupon-missing"),
    "a vernier line is moved": (_strokes(Role.VERNIER, _first_moved(0.1, 0)), "coupon-missing"),
    "a bar is moved": (_strokes(Role.RULER, _first_moved(0, 1.0)), "coupon-missing"),
    "a letter lacks a stroke": (_strokes(Role.LABEL, lambda s: s[1:]), "coupon-missing"),
    "words are mirrored": (reverse_words_are_mirrored, "coupon-missing"),
    "words are repeated": (
        _operations(Role.LABEL, lambda op: op.model_copy(update={"repeats": 2})),
        "coupon-figures",
    ),
    "words are pressed hard": (_setup("front-words", force=240.0), "coupon-figures"),
    "two rungs change places": (two_rungs_change_places, "coupon-figures"),
    "the usual score is faster": (_setup("front-score", speed=200.0), "coupon-figures"),
    "a rung is too deep": (_rung("depth", -1, value=0.7), "coupon-rung"),
    "a rung is too strong": (_rung("force", -1, value=900.0), "coupon-rung"),
    "a rung is tried twice": (_rung("repeats", 0, value=2.0), "coupon-rung"),
    "the usual figure is missing": (_rung("spacing", 2, value=1.7), "coupon-rung"),
    "a hole is too small for a knife": (_rung("relief", 1, value=1.0), "coupon-rung"),
    "a word says another depth": (a_word_says_another_depth, "coupon-label"),
    "a vernier's number is wrong": (a_vernier_number_is_wrong, "coupon-number"),
    "a vernier's pitch is wrong": (_vernier(reverse_pitch=10.2), "coupon-vernier"),
    "a vernier is missing": (a_vernier_is_missing, "coupon-vernier"),
    "the ties are missing": (the_patches_have_no_ties, "coupon-ties"),
    "the bars are shorter than said": (the_bars_are_shorter_than_said, "coupon-missing"),
    "a cell lies on another": (a_cell_lies_on_another, "coupon-overlap"),
    "a valley is made on the front": (_rung("hinge", 2, face="front"), "coupon-figures"),
}
