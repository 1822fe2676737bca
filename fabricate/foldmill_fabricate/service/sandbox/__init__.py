"""Run a function of ours in a process that can be killed, with limits on all it may use up.

A *nursery* is a process that has imported everything and does nothing but fork. Each piece of work
runs in a fresh child of it, so that none pays for imports and none leaves anything behind for the
next. Arguments go in as JSON and files, results come out as JSON and files; nothing is pickled.
"""

from __future__ import annotations

from foldmill_fabricate.confining import Limits, TooMuch
from foldmill_fabricate.service.sandbox.pool import Sandbox
from foldmill_fabricate.service.sandbox.refusals import Refused, SandboxFailed, TooBusy

__all__ = ["Limits", "Refused", "Sandbox", "SandboxFailed", "TooBusy", "TooMuch"]
