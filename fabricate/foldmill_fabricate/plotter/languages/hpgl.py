"""HP-GL, whose units end with ``;``."""

from __future__ import annotations

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter import resume
from foldmill_fabricate.plotter.program import Job, checked, ready, rechunk
from foldmill_fabricate.plotter.resume import Start


class HpGl:
    """HP-GL as ``program`` and ``resume`` read it."""

    def as_sent(self, program: bytes, machine: Machine, limit: int) -> bytes:
        """Return the same path in instructions of at most ``limit`` bytes."""
        return rechunk(checked(program, machine), limit)

    def ready(self, program: bytes, machine: Machine) -> Job:
        """Divide it and find what each instruction takes."""
        return ready(program, machine)

    def rest(self, job: Job, machine: Machine, limit: int, start: Start) -> Job:
        """Return what is left, from a vertex inside a stroke too."""
        return resume.rest(job, machine, limit, start)

    def lead_in(self, job: Job, stroke: int) -> tuple[int, ...]:
        """Return the first stroke after the tool was chosen."""
        return resume.lead_in(job, stroke)
