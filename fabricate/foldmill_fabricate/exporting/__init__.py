"""Patterns for other people's origami programs: in a file that each accepts, or refused by name.

A *profile* is one program, with the kinds of files it reads and what each of them cannot hold. A
pattern that would lose something is refused with a sentence that says what; whoever knows it may
have the file all the same.
"""

from __future__ import annotations

from foldmill_fabricate.exporting.export import Exported, export
from foldmill_fabricate.exporting.programs import PROGRAMS, Program, Writer

__all__ = ["PROGRAMS", "Exported", "Program", "Writer", "export"]
