"""Lines of any origin become a planar graph: split where they cross, none upon another.

A crease pattern is such a graph already; lines of other people's files are not. ``lines`` does the
work, ``splitting`` welds and splits, ``joints`` closes joints that nothing meets.
"""

from __future__ import annotations

from foldmill.planarise.lines import (
    Change,
    Planar,
    planarise,
    planarise_graph,
    planarise_pattern,
)

__all__ = ["Change", "Planar", "planarise", "planarise_graph", "planarise_pattern"]
