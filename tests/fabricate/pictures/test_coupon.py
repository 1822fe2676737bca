"""The pictures that explain a coupon."""

from __future__ import annotations

from pathlib import Path

from coupons import coupon, declared

from foldmill_fabricate.pictures.coupon import cells_picture, coupon_picture, vernier_picture

DOCS = Path(__file__).parents[3] / "docs"


def test_the_page_shows_the_pictures_the_code_draws() -> None:
    _, plan = coupon()
    page = (DOCS / "coupon.md").read_text(encoding="utf-8")
    for name, draw in (
        ("coupon", coupon_picture),
        ("coupon-cells", cells_picture),
        ("coupon-vernier", vernier_picture),
    ):
        assert f"(pictures/{name}.png)" in page
        drawn = draw(plan, declared(plan))
        assert drawn == draw(plan, declared(plan))
        assert drawn.startswith(b"\x89PNG")
        assert (DOCS / "pictures" / f"{name}.png").is_file()
