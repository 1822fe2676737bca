"""What a person read from a coupon: the file they fill in, and the model it is read into."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import date
from typing import Annotated, Any

from pydantic import AfterValidator, Field

from foldmill_fabricate.ladders import Coupon, LadderKind
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.presets import Preset
from foldmill_fabricate.units import Celsius, Deg, GramForce, Mm

NAME = "coupon-answers.toml"
"""Its name in the coupon's folder."""


class BarsRead(Preset):
    """Distances of the crosses' middles, measured with a steel rule."""

    ab: Mm | None = Field(None, gt=0)
    """From A to B."""
    ad: Mm | None = Field(None, gt=0)
    """From A to D."""
    ac: Mm | None = Field(None, gt=0)
    """From A to C."""
    bd: Mm | None = Field(None, gt=0)
    """From B to D."""


class VernierRead(Preset):
    """The numbers at which the lines of both faces meet in one straight line."""

    x: float | None = None
    """Tenths of a mm along x; half-way between two numbers where both meet equally well."""
    y: float | None = None
    """The same along y."""


class Springback(Preset):
    """How far hinges opened again after they were folded and let go."""

    at_90: Deg | None = Field(None, ge=0, le=90)
    """Of a strip folded to 90°."""
    at_180: Deg | None = Field(None, ge=0, le=180)
    """Of a strip folded to 180°."""


class Best(Preset):
    """The rung of each ladder that folds best; only values that stand on the coupon."""

    depth: Mm | None = None
    """Blade."""
    force: GramForce | None = None
    """Force."""
    repeats: int | None = None
    """How often the tool goes over a score."""
    gap: Mm | None = None
    """The longest land between two cuts at which a fold still follows the row."""
    spacing: Mm | None = None
    """The smallest distance at which the sheet between two scores stays whole."""
    relief: Mm | None = None
    """The smallest hole that keeps the middle of a patch from tearing."""


def _day(text: str) -> str:
    """Return a day of the calendar as it was written; raises ValueError for what is none."""
    try:
        is_day = date.fromisoformat(text).isoformat() == text
    except ValueError:
        is_day = False
    if not is_day:
        raise ValueError("write the day as YYYY-MM-DD")
    return text


class Answers(Preset):
    """Everything that was read from one coupon."""

    read_by: str = Field(min_length=1)
    """Who read it."""
    read_on: Annotated[str, AfterValidator(_day)]
    """When, as YYYY-MM-DD."""
    temperature: Celsius | None = Field(None, ge=-20, le=60)
    """Of the room, while both faces were made."""
    best: Best = Best()
    hinge: Springback = Springback.model_validate({})
    bars: BarsRead = BarsRead.model_validate({})
    vernier: VernierRead = VernierRead()


_ASKS: dict[LadderKind, tuple[str, str]] = {
    "depth": ("the depth that folds best without tearing", " mm"),
    "force": ("the force that folds best", " gf"),
    "repeats": ("how many repeats fold best", ""),
    "gap": ("the longest land between cuts at which the fold still follows the row", " mm"),
    "spacing": ("the smallest distance at which the sheet between the scores stays whole", " mm"),
    "relief": (
        "the smallest hole that does not tear when folded flat; 0 where none is needed",
        " mm",
    ),
}


def template(plan: Plan, coupon: Coupon) -> str:
    """Return the file to fill in: every line commented out but those that must be there."""
    return "\n".join([*_head(plan), *_best(coupon), *_hinge(coupon), *_measured(coupon), ""])


def _head(plan: Plan) -> Iterator[str]:
    yield f"# What was read from: {plan.title}."
    yield "# Take away the # in front of each line you can answer; leave the others as they are."
    yield 'read_by = ""'
    yield 'read_on = ""  # YYYY-MM-DD'
    yield '#temperature = "20 °C"'


def _best(coupon: Coupon) -> Iterator[str]:
    yield from ("", "[best]")
    for ladder in coupon.ladders:
        if ladder.kind in _ASKS:
            about, unit = _ASKS[ladder.kind]
            values = [f"{rung.value:g}{unit}" for rung in ladder.rungs]
            first = f'"{values[0]}"' if unit else values[0]
            yield f"# {about}: one of {', '.join(values)}"
            yield f"#{ladder.kind} = {first}"


def _hinge(coupon: Coupon) -> Iterator[str]:
    if any(ladder.kind == "hinge" for ladder in coupon.ladders):
        yield from ("", "[hinge]")
        yield "# by how much a strip opened again after a minute, folded to 90° and to 180°"
        yield '#at_90 = "25 deg"'
        yield '#at_180 = "35 deg"'


def _measured(coupon: Coupon) -> Iterator[str]:
    bars = coupon.bars
    across = (bars.width**2 + bars.height**2) ** 0.5
    yield from ("", "[bars]", "# from middle to middle of the crosses, to 0.1 mm if you can")
    for name, length in (("ab", bars.width), ("ad", bars.height), ("ac", across), ("bd", across)):
        yield f'#{name} = "{length:.1f} mm"'
    yield from ("", "[vernier]", "# the number at which the lines of both faces are one line;")
    yield "# half-way, such as 3.5, where two neighbours meet equally well"
    for axis in ("x", "y"):
        low, high = number_range(coupon, axis)
        yield f"#{axis} = 0  # {low} to {high}"


def number_range(coupon: Coupon, axis: str) -> tuple[int, int]:
    """Return the least and the greatest number that stand at the verniers of an axis."""
    numbers: list[int] = []
    for vernier in (v for v in coupon.verniers if v.axis == axis):
        middle = -round(10 * vernier.shift)
        numbers += [middle - vernier.each_way, middle + vernier.each_way]
    return min(numbers), max(numbers)


def plain(answers: Any) -> str:
    """Return who read a coupon, when, and at which temperature."""
    warm = "" if answers.temperature is None else f", {answers.temperature:g} °C"
    return f"coupon read by {answers.read_by} on {answers.read_on}{warm}"
