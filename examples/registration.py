"""Make the pictures of docs/registration.md: each way to keep the faces in register, and its error.

Everything is a stool of polypropylene 0.75 mm on a sheet of 500 × 500 mm. The table of errors is
printed as it stands on the page.
"""

import sys
from pathlib import Path

from foldmill import installed
from foldmill_fabricate import shelf
from foldmill_fabricate.files import write_all
from foldmill_fabricate.jobsheet.flip_drawing import flip_picture
from foldmill_fabricate.kinds import RegistrationKind
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.pictures.budget import budget_picture
from foldmill_fabricate.plan import make

KINDS: dict[RegistrationKind, str] = {
    "holes": "generic-hpgl-600",
    "l-marks": "graphtec-summa-like",
    "pins": "flatbed-wheel-knife",
    "edge": "generic-hpgl-600",
}
"""Which machine shows which kind."""


def plans() -> dict[str, Plan]:
    """Plan the stool once for each kind of registration."""
    design = installed().design("tuck")
    stool, sheet = design.run(design.preset("stool-n8")), shelf.material("pp-0.75")
    return {
        kind: make(stool, sheet, shelf.machine(slug), register=kind) for kind, slug in KINDS.items()
    }


def table(made: dict[str, Plan]) -> str:
    """Return the errors as a table in Markdown, mm."""
    budgets = {kind: plan.budget for kind, plan in made.items() if plan.budget}
    names = [share.name for share in next(iter(budgets.values())).shares]
    lines = [f"| | {' | '.join(names)} | likely | at worst |", "|---|" + "---|" * (len(names) + 2)]
    for kind, budget in budgets.items():
        errors = [*(share.error for share in budget.shares), budget.likely, budget.worst]
        lines.append(f"| {kind} | {' | '.join(f'{error:.2f}' for error in errors)} |")
    return "\n".join(lines)


def main(folder: Path) -> None:
    """Write the pictures into a folder and print the table."""
    made = plans()
    pictures = {f"pictures/register-{kind}.png": flip_picture(plan) for kind, plan in made.items()}
    budgets = {kind: plan.budget for kind, plan in made.items() if plan.budget}
    pictures["pictures/register-error.png"] = budget_picture(budgets)
    write_all(folder, pictures)
    print(table(made))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/registration"))
