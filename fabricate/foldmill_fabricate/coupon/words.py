"""How a coupon is read, one line for each of its parts."""

from __future__ import annotations

from collections.abc import Iterator

from foldmill_fabricate.coupon.answers import NAME, number_range
from foldmill_fabricate.ladders import Coupon, Ladder, LadderKind
from foldmill_fabricate.passes import Plan

_HOW: dict[LadderKind, str] = {
    "depth": (
        "each strip is scored with the blade at the depth below it (mm). Bend all of them by "
        "180° five times, {sense}; the best is the shallowest that folds in one sharp line."
    ),
    "force": (
        "each strip is scored with the force below it (gf), all else as usual. Bend all of them by "
        "180° five times, {sense}; the best is the least force from which on the fold gets no "
        "easier."
    ),
    "repeats": (
        "the tool goes over each score as often as the figure below says. Bend all of them by 180° "
        "five times; the best is the least number from which on the fold gets no easier."
    ),
    "gap": (
        "the land between two cuts is as long as the figure below says (mm). Bend each strip by "
        "180° five times; the best is the longest land at which the fold still follows the row."
    ),
    "spacing": (
        "two scores as far apart as the figure below says (mm). Bend both by 90°; the best is the "
        "smallest distance at which the sheet between them stays whole and flat."
    ),
    "hinge": (
        "fold the strips to 90° and to 180° as the figure says (two on each face where both are "
        "scored), hold for ten seconds, let go, and measure after a minute by how much they opened."
    ),
    "relief": (
        "{degree} creases meet in a hole of the diameter below (mm; 0: no hole, the scores stop "
        "short). Cut the ties, fold the patch flat; the best is the smallest hole without a tear."
    ),
}
_SENSES = {
    "outside": "away from the groove",
    "inside": "towards the groove",
    "either": "to both sides",
}


def lines(plan: Plan, coupon: Coupon) -> Iterator[tuple[str, str]]:
    """Yield a name and a line for each ladder, the verniers, the bars, and how to record them."""
    sense = _SENSES[plan.material.score.score_face]
    for ladder in coupon.ladders:
        how = _HOW[ladder.kind].format(sense=sense, degree=coupon.degree)
        yield f"{ladder.kind.capitalize()} ({_values(ladder)})", how
    for axis in ("x", "y"):
        low, high = number_range(coupon, axis)
        yield f"Vernier {axis} ({low} to {high})", _vernier(coupon, axis)
    bars = coupon.bars
    across = (bars.width**2 + bars.height**2) ** 0.5
    right = (
        f"measure from middle to middle of the crosses with a steel rule: A to B {bars.width:g} mm "
        f"if the machine is right, A to D {bars.height:g} mm, A to C and B to D {across:.1f} mm."
    )
    yield "Bars A, B, C, D", right
    command = (
        f"write what you read into {NAME} beside this sheet, then: foldmill coupon --record "
        f"FOLDER --material {plan.material.slug} --machine {plan.machine.slug}"
    )
    yield "Record", command


def _values(ladder: Ladder) -> str:
    values = dict.fromkeys(f"{rung.value:g}" for rung in ladder.rungs)
    return ", ".join(values)


def _vernier(coupon: Coupon, axis: str) -> str:
    if axis == "y":
        return "in the same way, in the columns on the left: along y."
    seen = (
        "slits through the sheet, from either face"
        if coupon.slits
        else "hold the sheet against the light"
    )
    return (
        f"in the rows along the lower edge find the front's line and the reverse's that are one "
        f"straight line ({seen}); "
        f"its number says by how many tenths of a mm the reverse lies along x. Where "
        f"two neighbours meet equally well take the number between them; where none meet, "
        f"record the bars and make the coupon again."
    )
