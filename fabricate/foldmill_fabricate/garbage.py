"""How often a process of ours looks for garbage."""

from __future__ import annotations

import gc

_MADE, _YOUNG, _OLD = 20_000, 10, 20


def look_rarely() -> None:
    """Let the collector look after 20,000 new objects, not 700.

    What is made here are values without cycles, which need no collector, and a hundred thousand
    objects of imported code, which stay: planning the stool takes a fifth less time so, and no more
    memory. For processes of ours only; whoever imports foldmill decides that for theirs.
    """
    gc.set_threshold(_MADE, _YOUNG, _OLD)
