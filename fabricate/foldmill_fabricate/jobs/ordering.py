"""Make an ordered design into a job folder, in a process of its own.

Planning takes seconds to minutes of a processor; machines at work must not wait for it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from threading import Event
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from foldmill.errors import InvalidInput
from foldmill.files import fence_process
from foldmill.refusals import explain
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.jobs.elsewhere import Silent, done, serve
from foldmill_fabricate.jobs.errors import Leave
from foldmill_fabricate.jobs.values import Order

Size = tuple[float, float]
_MOST_MEMORY, _MOST_SECONDS = 4 << 30, 3600
"""bytes, and s of a processor, that an order may take."""


class Options(BaseModel):
    """How a sheet is planned: the options of `foldmill plan`, by name."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    blank: Size | None = None
    """width and height, mm; by default the material's stock"""
    carrier: Size | None = None
    """width and height, mm; by default the machine's mat"""
    flip: Literal["left-right", "end-over-end"] = "left-right"
    unassigned: Literal["front", "reverse", "skip"] | None = None
    score: str | None = None
    outline: str | None = None
    relief: Literal["none", "needed", "all"] = "none"
    copies: int = Field(default=1, ge=1, le=10_000)
    grid: tuple[int, int] | None = None
    registration: Literal["holes", "l-marks", "edge", "pins", "none"] = "holes"
    temperatures: Size | None = None
    """of the sheet at both passes, °C"""

    def for_make(self) -> dict[str, Any]:
        """Return them by the names of ``plan.make``."""
        given = dict(self)
        given["cut"] = given.pop("outline")
        given["register"] = given.pop("registration")
        return given


def options(given: dict[str, Any]) -> Options:
    """Return options; raises InvalidInput with a sentence."""
    try:
        return Options.model_validate(given)
    except ValidationError as error:
        raise InvalidInput(f"Options of planning: {explain(error)}") from None


def carry_out(order: Order, folder: Path) -> None:
    """Design and plan into a folder, in this process; raises FoldmillError."""
    from foldmill import installed
    from foldmill_fabricate import folder as folders
    from foldmill_fabricate import shelf
    from foldmill_fabricate.plan import make
    from foldmill_fabricate.writers import writer

    chosen = options(order.options)
    family = installed().design(order.family)
    values = family.preset(order.preset).model_dump() if order.preset else {}
    fold = family.run(family.validate({**values, **order.params}))
    material, machine = shelf.material(order.material), shelf.machine(order.machine)
    if not writer(machine):
        raise CannotPlan(f"Nothing installed writes programs in {machine.language}.")
    plan = make(fold, material, machine, **chosen.for_make())
    folders.write(fold, plan, folder, ["svg", "dxf", machine.language])


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
        refused = done("foldmill_fabricate.jobs.ordering", told, listen)["refused"]
    except Silent as end:
        raise CannotPlan(
            f"Planning took more than {_MOST_SECONDS / 3600:g} h of a processor, or was stopped "
            f"from outside (code {end.code}). Make the design simpler, or plan it by hand and "
            "submit the folder."
        ) from None
    if refused:
        raise CannotPlan(refused)


def _carried_out(told: dict[str, Any]) -> dict[str, str]:
    """Carry out an order, within limits; raises FoldmillError."""
    _limit()
    fence_process(None)  # an order comes from elsewhere: it names no file of this computer
    try:
        carry_out(Order.model_validate(told["order"]), Path(told["folder"]))
    except MemoryError:
        raise CannotPlan(
            f"Planning this needs more than {_MOST_MEMORY >> 30} GB of memory; make it simpler."
        ) from None
    return {}


def _limit() -> None:
    """Let this process end rather than the computer, where an order asks for too much."""
    if sys.platform == "win32":
        return
    import resource

    resource.setrlimit(resource.RLIMIT_DATA, (_MOST_MEMORY, _MOST_MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (_MOST_SECONDS, _MOST_SECONDS))


if __name__ == "__main__":
    serve(_carried_out)
