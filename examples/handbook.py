"""Make docs/materials-and-machines.md and its pictures: plan the stool on everything there is."""

import sys
from pathlib import Path

from foldmill import installed
from foldmill_fabricate import handbook
from foldmill_fabricate.files import write_all


def main(folder: Path) -> None:
    """Write the page and its pictures into a folder."""
    design = installed().design("tuck")
    page = handbook.page(design.run(design.preset("stool-n8")))
    write_all(folder, {"materials-and-machines.md": page.encode(), **handbook.pictures()})
    print(folder / "materials-and-machines.md")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/handbook"))
