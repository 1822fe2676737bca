"""Print the SHA-256 of every file of some jobs, for any interpreter.

    python job_digests.py FOLDER [--whole]

The small ones without --whole; with it those of three languages, and the pattern of every preset.
"""

from __future__ import annotations

import hashlib
import json
import sys
from pathlib import Path

from foldmill import installed
from foldmill.exchange import write
from foldmill_fabricate import folder, shelf
from foldmill_fabricate.plan import make

JOBS = (
    ("generic-hpgl-600", "pp-0.75", ["svg", "dxf", "cf2", "hpgl", "places"]),
    ("silhouette-like", "card-250", ["gp-gl"]),
    ("grbl-drag-knife", "pp-0.75", ["gcode"]),
)
"""Machine, material and formats of each."""


def digests(target: Path, *, whole: bool) -> dict[str, str]:
    """Return the digest of every file of the jobs, and of presets' patterns."""
    stool = installed().design("tuck")
    fold = stool.run(stool.preset("stool-n8"))
    for machine, material, formats in JOBS[: None if whole else 1]:
        plan = make(fold, shelf.material(material), shelf.machine(machine))
        folder.write(fold, plan, target / machine, formats)
    found = {
        str(path.relative_to(target)): path.read_bytes()
        for path in sorted(target.rglob("*"))
        if path.is_file()
    }
    for slug, design in sorted(installed().designs.items()):
        for preset in list(design.presets)[: None if whole else 1]:
            found[f"{slug} {preset}"] = write(design.run(design.preset(preset))).encode()
    return {name: hashlib.sha256(content).hexdigest() for name, content in found.items()}


if __name__ == "__main__":
    sys.stdout.write(json.dumps(digests(Path(sys.argv[1]), whole="--whole" in sys.argv), indent=1))
