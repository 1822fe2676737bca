"""Compute beside machines that are at work, without keeping them waiting."""

from __future__ import annotations

import os

LOWEST = 19
"""The lowest priority there is. Four designs made a sender on two cores up to 142 ms late at the
usual one, 53 at 10, 46 at 19: benchmarks/many_plotters.py."""


def step_aside() -> None:
    """Let this process, and what it starts, compute only when nothing else has anything to do."""
    if hasattr(os, "nice"):
        os.nice(LOWEST)
