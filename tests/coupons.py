"""Coupons, made once per test process."""

from __future__ import annotations

from functools import cache
from typing import Any, Literal

from foldmill import Fold, installed
from foldmill_fabricate.coupon.make import make
from foldmill_fabricate.kinds import Kind
from foldmill_fabricate.ladders import Coupon
from foldmill_fabricate.passes import Plan


@cache
def coupon(
    material: str = "pp-0.75",
    machine: str = "generic-hpgl-600",
    score: Kind | None = None,
    flip: Literal["left-right", "end-over-end"] = "left-right",
    degree: Literal[4, 6] = 4,
    blank: tuple[float, float] | None = None,
) -> tuple[Fold, Plan]:
    of: Any = installed().get("foldmill_materials", "material", material)
    on: Any = installed().get("foldmill_machines", "machine", machine)
    return make(of, on, score=score, flip=flip, degree=degree, blank=blank)


def declared(plan: Plan) -> Coupon:
    """Return what a coupon's plan declares."""
    assert plan.coupon is not None
    return plan.coupon
