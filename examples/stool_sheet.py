"""A stool sheet from Python: design, check, plan, write, verify. Give it a folder to write to."""

import sys
from pathlib import Path

from foldmill import installed
from foldmill.check import check
from foldmill_fabricate import folder
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import verify_folder


def main(out: Path) -> None:
    """Make the eight-legged stool for a machine that selects its tools."""
    registry = installed()
    tuck = registry.design("tuck")
    fold = tuck.run(tuck.preset("stool-n8"))

    report = check(fold)
    print("penetrations:", report.figures["penetrations"])

    material = registry.get("foldmill_materials", "material", "pp-0.75")
    machine = registry.get("foldmill_machines", "machine", "generic-hpgl-pens")
    plan = folder.write(fold, make(fold, material, machine), out, ["svg", "dxf", "hpgl"])
    print("set-ups:", ", ".join(s.name for work in plan.passes for s in work.setups))

    proof = verify_folder(out)
    print("verified:", proof.ok)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/stool-sheet"))
