"""Draw every preset of every installed family into a page of pictures."""

import sys
from pathlib import Path

from foldmill import installed
from foldmill_fabricate.files import write_all
from foldmill_fabricate.pictures import gallery


def main(folder: Path) -> None:
    """Write gallery.md and its pictures into a folder."""
    write_all(folder, gallery(installed().designs))
    print(folder / "gallery.md")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/gallery"))
