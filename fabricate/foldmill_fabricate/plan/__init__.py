"""Fold + material + machine → plan: passes, set-ups, operations and strokes.

Start at ``make``. Each module answers one question: ``sides`` which face a crease is scored on,
``placement`` how the part lies on the blank, ``registration`` how the flip keeps register,
``scores`` where scores begin and end, ``outline`` how the part is cut free, ``setups`` in which
order, ``lead_ins`` where a drag knife is turned before each, ``rules`` and ``spacing`` what a
person should know before cutting.
"""

from foldmill_fabricate.plan.make import make

__all__ = ["make"]
