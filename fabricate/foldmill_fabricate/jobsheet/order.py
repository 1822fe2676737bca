"""What the job sheet says to whoever folds the part: the table of creases and the order of folding.

An order is computed only where a motion from the flat sheet to the form is known. Elsewhere it is
read from how the creases lie, and the sheet says so; where they lie in no order, it says that.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, Fold
from foldmill_fabricate.jobsheet.creases import Arrangement, CreaseGroup
from foldmill_fabricate.jobsheet.moving import SHARES, Closing
from foldmill_fabricate.jobsheet.words import Row
from foldmill_fabricate.passes import Plan

KINDS = {
    Assignment.M: "mountain",
    Assignment.V: "valley",
    Assignment.U: "unassigned",
}
_GROOVES = {
    "outside": "away from its groove, which opens",
    "inside": "towards its groove, which closes",
    "either": "both ways",
}
_FRONT = {
    "outside": "The front has the grooves of the mountains, the reverse those of the valleys.",
    "inside": "The front has the grooves of the valleys, the reverse those of the mountains.",
    "either": "Both faces look alike: before that, write an F on the front, which lay underneath.",
}
_FREED = {
    "through-cut": "Take the {part} out of {its} ties and cut them flush.",
    "score-and-snap": "Bend the waste back along the outline until it snaps off, side by side.",
    "pen": "Cut the {part} out by hand along {its} drawn outline.",
}
ALIKE = 0.5
"""deg. Angles that differ by no more are told as one."""


def crease_table(
    how: Arrangement, closing: Closing | None = None, fold: Fold | None = None
) -> list[Row]:
    """Return the table of creases, its head first: letter, fold, angle, how many, and where.

    Where a motion from the flat sheet is known, the angles on its way stand instead of the place.
    """
    head = ["", "fold", "angle", "creases"]
    if closing is not None and closing.opens_flat and fold is not None:
        on_the_way = closing.angles(fold)
        shares = [f"at {share:.0%}" for share in SHARES]
        return [
            (*head, *shares),
            *((*_row(group), *_passed(on_the_way, group)) for group in how.groups),
        ]
    places = how.name if how.kind != "none" else ""
    return [
        (*head, places),
        *((*_row(g), f"{g.distance:.0f} mm" if places else "") for g in how.groups),
    ]


def _row(group: CreaseGroup) -> Row:
    unknown = group.assignment is Assignment.U and not group.angle
    angle = f"{group.angle:.1f}°"
    if group.spread > ALIKE:
        angle = f"{group.angle:.0f}° ± {group.spread / 2:.0f}°"
    number = f"× {len(group.edges)}"
    return (group.letter, KINDS[group.assignment], "unknown" if unknown else angle, number)


def _passed(on_the_way: NDArray[np.float64], group: CreaseGroup) -> list[str]:
    return [f"{abs(angles[group.edges]).mean():.0f}°" for angles in on_the_way]


def folding_steps(
    plan: Plan, how: Arrangement, seams: int = 0, closing: Closing | None = None
) -> list[str]:
    """Return the suggested order of folding, step by step; seams : vertices that are to meet."""
    flex = (
        f"Bend every scored crease 3 to 5 times, {_GROOVES[plan.material.score.score_face]}, along "
        f"a straight edge: mountains with the front outside, valleys with the reverse outside."
    )
    one = plan.quantity == 1
    part, its = ("part", "its") if one else (f"{plan.quantity} parts", "their")
    freed = _FREED[plan.material.cut.kind].format(part=part, its=its)
    steps = [f"{freed} {_FRONT[plan.material.score.score_face]}", flex]
    steps += _closing_steps(how, closing)
    if seams:
        steps.append(
            "Close the seam: bring its two edges together, tabs on the inside where there are any, "
            "and glue or tape it from one end to the other."
        )
    return [*steps, _springback(plan)]


def derived(how: Arrangement, closing: Closing | None, fold: Fold) -> str:
    """Return where the order of folding comes from, and what it is worth."""
    basis = _basis(how, closing)
    if basis == "motion":
        return (
            "This is computed: a motion with rigid facets leads from the flat sheet to the form. "
            "A real sheet bends a little beside its creases, so the angles on the way are a guide."
        )
    if basis == "rings":
        return (
            "This order is not computed and not tried: it is read from the pattern, whose rings of "
            "creases carry what lies outside them."
        )
    if basis == "rows":
        return (
            "This order is not computed and not tried: it is read from the pattern, whose rows of "
            "creases hang together all along the strip."
        )
    known = "" if fold.folded is not None else " Its folded form is not known either."
    return f"No order of folding is known for this pattern.{known} What is said is common practice."


def _basis(how: Arrangement, closing: Closing | None) -> Literal["motion", "rings", "rows", "none"]:
    """Return what an order of folding can be taken from; a form that ends flat has no rings."""
    if closing is not None and closing.opens_flat:
        return "motion"
    return "none" if all(group.is_closed for group in how.groups) else how.kind


def _closing_steps(how: Arrangement, closing: Closing | None) -> list[str]:
    basis = _basis(how, closing)
    standing = [group for group in how.groups if not group.is_closed]
    closed = [group for group in how.groups if group.is_closed]
    if basis == "motion":
        return [_together()]
    if basis == "none":
        return [_at_once(bool(closed) and not standing)]
    along = (
        "Go from the middle outward, each group all the way round"
        if basis == "rings"
        else f"Go row by row, beginning {how.name}, each group all along the strip"
    )
    steps = [
        f"{along} to half its angle before the next: {_listed(standing)}.",
        "Go through them once more in the same order, now to the full angle.",
    ]
    if closed:
        steps.insert(1, _swinging(closed))
        steps.append(
            f"Close the tucks last: {', '.join(g.letter for g in closed)}. Press them flat."
        )
    return steps


def _swinging(closed: Sequence[CreaseGroup]) -> str:
    """Say what becomes of the tucks while the rest is folded."""
    letters = {
        kind: ", ".join(group.letter for group in closed if group.assignment == kind)
        for kind in KINDS
    }
    sides = [
        f"{letters[kind]} ({touching} meets {touching})"
        for kind, touching in ((Assignment.V, "front"), (Assignment.M, "reverse"))
        if letters[kind]
    ]
    return (
        f"Meanwhile the tucks close between them: {' and '.join(sides)}. Push them in the way they "
        f"are drawn, so that each begins to lie on itself, and leave them loose."
    )


def _together() -> str:
    return (
        f"Close all creases together, a little at a time and all the way round: no crease has to "
        f"wait for another. The table says how far each is at {SHARES[0]:.0%}, {SHARES[1]:.0%} and "
        f"{SHARES[2]:.0%} of the way; the pictures show the form there."
    )


def _at_once(flat: bool) -> str:
    ends = " Its creases all close to 180°: it ends flat." if flat else ""
    return (
        "Give every crease a third of its angle, mountains and valleys as drawn, beginning in the "
        "middle of the sheet. Then push it together from the edges: creases that meet in a corner "
        f"move each other. Work the whole sheet up evenly to the full angles.{ends}"
    )


def _listed(groups: Sequence[CreaseGroup]) -> str:
    return ", ".join(f"{group.letter} {KINDS[group.assignment]}" for group in groups)


def _springback(plan: Plan) -> str:
    material = plan.material
    by = f" by {material.springback_min:g} to {material.springback_max:g}°"
    cold = material.min_fold_temperature
    warm = "" if cold is None else f" Do not fold below {cold:g} °C."
    grain = " It folds more sharply along its grain than across it." if material.directional else ""
    return (
        f"The sheet springs back{by}: overfold where there is room, hold each fold for some "
        f"seconds, and hold the finished form (clips, tape) until it stays.{warm}{grain}"
    )
