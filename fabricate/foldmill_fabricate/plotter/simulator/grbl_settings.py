"""The settings of a GRBL machine, as far as they mean something here."""

from __future__ import annotations

import re
from collections.abc import Sequence

from foldmill_fabricate.machines import Machine

_SET = re.compile(r"\$(\d{1,3})=(\d{1,9}(?:\.\d{0,9})?)")
_KNOWN = frozenset(
    n + 10 * tens
    for tens, last in ((0, 6), (1, 3), (2, 7), (3, 2), (10, 2), (11, 2), (12, 2), (13, 2))
    for n in range(last + 1)
)
"""Numbers of all settings of GRBL 1.1; most mean nothing here, and are kept."""
_EPSILON = 1e-6
"""mm, beyond the travel that is still within."""


class Settings:
    """``$n=value``: $10 what a status tells, $20 soft limits, $32 laser, $130 and $131 travel."""

    planner = 15
    """Blocks that are planned ahead, the one that runs included."""

    def __init__(self, machine: Machine) -> None:
        steps, motion = machine.axes.units_per_mm, machine.motion
        beam = machine.tools.max_force is None  # only a laser presses on nothing
        self._values = {
            10: 1.0, 20: 1.0, 22: 0.0, 32: float(beam),
            100: steps, 101: steps, 110: motion.travel_speed * 60, 111: motion.travel_speed * 60,
            120: motion.acceleration, 121: motion.acceleration,
            130: machine.bed.width, 131: machine.bed.length,
        }  # fmt: skip

    @property
    def laser(self) -> bool:
        """Whether the spindle is a beam."""
        return bool(self._values[32])

    @property
    def tells_buffers(self) -> bool:
        """Whether a status tells the free blocks and bytes."""
        return bool(int(self._values[10]) & 2)

    def beyond(self, target: Sequence[float]) -> bool:
        """Whether a target, mm, is refused by the soft limits."""
        travel = (self._values[130], self._values[131])
        return bool(self._values[20]) and any(
            not -_EPSILON <= at <= most + _EPSILON
            for at, most in zip(target[:2], travel, strict=True)
        )

    def obey(self, line: str) -> bool:
        """Set a value, or find that there is an answer; False for an unknown command."""
        found = _SET.fullmatch(line)
        if found and int(found[1]) in _KNOWN:
            self._values[int(found[1])] = float(found[2])
            return True
        return line in ("$", "$$", "$I", "$#", "$N")

    def answer(self, line: str) -> str:
        """Return what is said before the ok."""
        answers = {
            "$$": "".join(f"${key}={value:.3f}\r\n" for key, value in sorted(self._values.items())),
            "$I": f"[VER:1.1f.20170801:]\r\n[OPT:V,{self.planner},128]\r\n",
            "$#": "[G54:0.000,0.000,0.000]\r\n",
            "$": "[HLP:$$ $# $G $I $N $x=val $X $H ~ ! ? ctrl-x]\r\n",
        }
        return answers.get(line, "")
