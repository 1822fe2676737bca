"""Make an ordered design into a job folder, in a process of its own.

Planning takes seconds to minutes of a processor; machines at work must not wait for it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from threading import Event
from typing import Any

from foldmill import installed
from foldmill.files import fence_process
from foldmill_fabricate.confining import PLANNING, TooMuch, confine, refusing
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.jobs.elsewhere import Late, Silent, done, serve
from foldmill_fabricate.jobs.errors import Leave
from foldmill_fabricate.jobs.values import Order

_PATIENCE = 3600.0
"""s by the clock on the wall: beside machines at work ten minutes of a processor take longer."""
_WHAT = "Planning this"


def carry_out(order: Order, folder: Path) -> None:
    """Design and plan into a folder, in this process; raises FoldmillError."""
    from foldmill_fabricate import folder as folders
    from foldmill_fabricate import shelf
    from foldmill_fabricate.plan import make
    from foldmill_fabricate.writers import require_writer, usual_formats

    family = installed().design(order.family)
    values = family.preset(order.preset).model_dump() if order.preset else {}
    fold = family.run(family.validate({**values, **order.params}))
    material, machine = shelf.material(order.material), shelf.machine(order.machine)
    require_writer(machine)
    plan = make(fold, material, machine, **order.options.for_make())
    folders.write(fold, plan, folder, usual_formats(machine))


def carry_out_elsewhere(
    order: Order, folder: Path, leaving: Event, heed: Callable[[], None] = lambda: None
) -> None:
    """Have another process design and plan; raises CannotPlan with its sentence, or Leave.

    heed : called again and again meanwhile; what it raises ends the planning.
    """

    def listen() -> None:
        if leaving.is_set():
            raise Leave("The service ends.")
        heed()

    told = {"order": order.model_dump(mode="json"), "folder": str(folder)}
    try:
        said = done("foldmill_fabricate.jobs.ordering", told, listen, _PATIENCE)
    except Late:
        raise CannotPlan(
            f"{_WHAT} was not done after {_PATIENCE / 3600:g} h and was stopped. Make it simpler: "
            "fewer lines, fewer copies."
        ) from None
    except Silent as end:
        raise CannotPlan(str(_why(end))) from None
    if said["refused"]:
        raise CannotPlan(said["refused"])


def _why(end: Silent) -> TooMuch | str:
    """Say why a process that plans has ended without a word."""
    return PLANNING.after(-end.code, _WHAT) or (
        f"Planning this ended by a fault of foldmill's ({end.why}). Plan it by hand with "
        "foldmill plan, and submit the folder."
    )


def _carried_out(told: dict[str, Any]) -> dict[str, str]:
    """Carry out an order, within limits; raises FoldmillError."""
    installed()  # what every plan needs is no part of what this one uses up
    confine(PLANNING)
    fence_process(None)  # an order comes from elsewhere: it names no file of this computer
    with refusing(PLANNING, _WHAT):
        carry_out(Order.model_validate(told["order"]), Path(told["folder"]))
    return {}


if __name__ == "__main__":
    serve(_carried_out)
