"""The smallest blank that a refusal names works, and one a millimetre shorter does not."""

from __future__ import annotations

import re

import numpy as np
import pytest
import stools
from fabricate.plan.test_copies import kite
from fabricate.plan.test_make import square

from foldmill import Fold
from foldmill_fabricate import shelf
from foldmill_fabricate.errors import CannotPlan, DoesNotFit
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Sheet
from foldmill_fabricate.plan import make
from foldmill_fabricate.plan.blanks import smallest
from foldmill_fabricate.plan.grids import Block, Grid
from foldmill_fabricate.plan.placement import lay_out

NAMED = re.compile(r"smallest blank that works(?: for \d+)? is ([\d.]+) × ([\d.]+) mm")
CARRIER = re.compile(r"--carrier ([\d.]+)x([\d.]+)")


def refusal(fold: Fold, machine: Machine, **options: object) -> str:
    with pytest.raises(DoesNotFit) as caught:
        make(fold, stools.material(), machine, **options)  # type: ignore[arg-type]
    return str(caught.value)


def named(said: str) -> tuple[float, float]:
    found = NAMED.search(said)
    assert found, said
    return float(found[1]), float(found[2])


def holds(block: Block, width: float, height: float) -> bool:
    sheet = Sheet(
        width=width, height=height, carrier_width=width, carrier_height=height, dx=0, dy=0
    )
    try:
        lay_out(block, sheet, lambda: "No")
    except DoesNotFit:
        return False
    return True


@pytest.mark.parametrize("seed", range(10))
def test_the_smallest_blank_of_random_copies_holds_them_and_none_a_millimetre_shorter_does(
    seed: int,
) -> None:
    rng = np.random.default_rng(seed)
    points = rng.normal(0, 60, (int(rng.integers(3, 9)), 2)) * rng.uniform(0.3, 2, 2)
    count = int(rng.integers(1, 6))
    shape = Grid(int(rng.integers(1, 4)), int(rng.integers(1, 3))) if seed % 3 == 0 else None
    block = Block.of(points, float(rng.uniform(0, 5)), count, shape)
    size = smallest(block)
    assert size is not None
    assert holds(block, *size)
    assert holds(block, *size[::-1]) or shape is not None
    assert not holds(block, size[0] - 1, size[1])
    assert not holds(block, size[0], size[1] - 1)


@pytest.mark.parametrize(
    ("fold", "slug", "options"),
    [
        (kite(300, 260), "generic-hpgl-600", {"blank": (200, 200)}),
        (kite(420, 90), "generic-hpgl-600", {"blank": (80, 410)}),
        (kite(120, 90), "generic-hpgl-600", {"blank": (200, 150), "copies": 5}),
        (kite(120, 90), "generic-hpgl-600", {"blank": (200, 150), "grid": (1, 3)}),
        (square("MVMV", 90), "generic-hpgl-600", {"blank": (700, 500), "copies": 3}),
        (square("MVMV", 90), "generic-hpgl-600", {"carrier": (700, 600), "copies": 3}),
        (square("MVMV", 220), "generic-hpgl-600", {"copies": 6}),
        (kite(330, 200), "hp-7475a", {"blank": (200, 200), "score": "pen", "cut": "pen"}),
    ],
    ids=["one", "long", "copies", "grid", "blank", "carrier", "roll", "a3"],
)
def test_the_named_blank_is_planned_and_written_and_one_a_millimetre_shorter_is_refused(
    fold: Fold, slug: str, options: dict[str, object]
) -> None:
    machine = shelf.machine(slug)
    material = shelf.material("paper-80-120") if "score" in options else stools.material()
    with pytest.raises(DoesNotFit) as caught:
        make(fold, material, machine, **options)  # type: ignore[arg-type]
    said = str(caught.value)
    width, height = named(said)
    larger = CARRIER.search(said)
    rest = {key: value for key, value in options.items() if key not in {"blank", "carrier"}}
    if larger:
        rest["carrier"] = (float(larger[1]), float(larger[2]))
    plan = make(fold, material, machine, blank=(width, height), **rest)  # type: ignore[arg-type]
    assert all(hpgl.write(plan, fold).values())
    for shorter in ((width - 1, height), (width, height - 1)):
        with pytest.raises(DoesNotFit):
            make(fold, material, machine, blank=shorter, **rest)  # type: ignore[arg-type]


def test_a_part_no_blank_of_this_machine_holds_is_said_to_need_another_machine() -> None:
    said = refusal(square("MVMV", 700), stools.machine())
    assert "another machine" in said
    assert named(said) == (702.0, 702.0)
    assert "takes 580 × 799.1 mm at the most" in said


def test_the_roll_is_told_by_its_carrier_only_where_the_mat_is_too_short() -> None:
    four = refusal(square("MVMV", 270), stools.machine(), copies=4, blank=(500, 500))
    assert named(four) == (543.0, 543.0)
    assert not CARRIER.search(four)
    six = refusal(square("MVMV", 250), stools.machine(), copies=6, blank=(500, 500))
    assert named(six) == (503.0, 754.0)
    assert CARRIER.search(six)


@pytest.mark.parametrize("copies", [1, 3])
def test_where_blades_are_led_in_the_waste_the_named_blank_has_some(copies: int) -> None:
    machine = shelf.machine("generic-hpgl-drag-knife")
    fold, material = square("MFMF", 90), stools.material()
    said = refusal(fold, machine, copies=copies, blank=(80, 80))
    found = re.search(r"A blank that works(?: for 3)? is ([\d.]+) × ([\d.]+) mm", said)
    assert found
    blank = float(found[1]), float(found[2])
    assert make(fold, material, machine, copies=copies, blank=blank).quantity == copies
    with pytest.raises(CannotPlan, match="no place in the waste") as caught:
        make(fold, material, machine, grid=(1, 1), blank=(92, 92))
    larger = re.search(r"A blank of ([\d.]+) × ([\d.]+) mm has room", str(caught.value))
    assert larger
    assert make(fold, material, machine, blank=(float(larger[1]), float(larger[2])))
