"""Draw the pictures of docs/coupon.md anew: ``python examples/coupon.py docs``."""

from __future__ import annotations

import sys
from pathlib import Path

from foldmill_fabricate import shelf
from foldmill_fabricate.coupon.make import make
from foldmill_fabricate.files import write_all
from foldmill_fabricate.pictures.coupon import cells_picture, coupon_picture, vernier_picture


def pictures() -> dict[str, bytes]:
    """Return the pictures of the page by file name."""
    _, plan = make(shelf.material("pp-0.75"), shelf.machine("generic-hpgl-600"))
    coupon = plan.coupon
    assert coupon is not None
    return {
        "pictures/coupon.png": coupon_picture(plan, coupon),
        "pictures/coupon-cells.png": cells_picture(plan, coupon),
        "pictures/coupon-vernier.png": vernier_picture(plan, coupon),
    }


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs")
    for name, content in pictures().items():
        write_all((folder / name).parent, {Path(name).name: content})
