"""A remade plan as a job folder: the same files as of any plan, the pattern copied."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from foldmill import CreasePattern, Fold
from foldmill.exchange import fold as fold_file
from foldmill_fabricate import folder
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.profiles import Style


def write_remake(
    plan: Plan, origin: Path, output: Path, formats: Sequence[str], style: Style | None = None
) -> Plan:
    """Write a remade plan into a folder of its own; return it with its programs named.

    origin : the folder that the sheet was begun from. Raises CannotPlan where both are one, for
    what the ledger knows of the sheet would be lost.
    """
    if origin.resolve() == output.resolve():
        raise CannotPlan(
            f"{output} is the folder that the sheet was begun from; write the rest into another."
        )
    if plan.whole.source is None:
        fold = fold_file.read((origin / folder.PATTERN).read_text("utf-8"), folder.PATTERN)
    else:
        fold = Fold(CreasePattern.from_lines([], [], [], []))
    return folder.write(fold, plan, output, formats, style)
