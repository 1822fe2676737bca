"""Anybody's crease pattern as a fold: one entry point for every format that is read.

``read_pattern`` takes a file or its bytes and what a person says of it, and returns the fold, what
was changed on the way (its findings) and what is still to be asked. Readers are offered by the hook
``foldmill_readers``. Each is given bytes only, opens nothing, and refuses what is above its limits,
so that a service may call it for strangers in a process with bounds of its own.
"""

from __future__ import annotations

from foldmill_fabricate.importing.reading import Imported, Question, read_pattern

__all__ = ["Imported", "Question", "read_pattern"]
