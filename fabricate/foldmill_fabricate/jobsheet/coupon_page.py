"""The second page of a coupon's job sheet: where everything is, and how each ladder is read."""

from __future__ import annotations

from foldmill_fabricate.coupon import words
from foldmill_fabricate.jobsheet.paper import LEFT, Paper
from foldmill_fabricate.ladders import Coupon
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.pictures import sheet


def coupon_page(plan: Plan, coupon: Coupon, notes: list[str]) -> Paper:
    """Return the page; notes : sentences on what planning found."""
    page = Paper()
    page.line(f"Reading: {plan.title}", 16, weight="bold")
    size = 112.0
    axes = page.window(LEFT + 20, page.y - size, 140, size)
    sheet.draw(axes, plan, letters=5.5)
    page.y -= size + 22
    for name, how in words.lines(plan, coupon):
        page.line(f"{name}: {how}", 7.5)
        page.y -= 0.4
    if coupon.left_out or notes:
        page.heading("What is not on it, and what planning found")
    for sentence in (*coupon.left_out, *notes):
        page.line(f"•  {sentence}", 7)
    return page
