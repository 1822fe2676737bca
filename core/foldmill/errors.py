"""The exceptions of foldmill. Each also inherits the builtin it means, so both habits catch it.

::

    FoldmillError
    ├── InvalidInput (ValueError)        a broken call or broken input
    │   ├── InvalidPattern               a crease pattern that is no graph of creases
    │   ├── InvalidParameters            parameters outside their bounds or contradicting each other
    │   ├── ImpossibleGeometry           parameters that are legal, but fold to nothing
    │   │   └── NoCandidate              a point of the strip has no place in space
    │   └── UnreadableFile               a file that is not what its name says
    ├── UnknownName (LookupError)        no such family, preset, material, machine or format
    └── PluginFault (TypeError)          a plugin that breaks its contract
        └── BrokenBatch                  a batch that returns what no batch may return

Their text is for people: what, where, by how much, what to do.
"""

from __future__ import annotations

from collections.abc import Iterable


class FoldmillError(Exception):
    """Root of every exception that foldmill raises on purpose."""


class InvalidInput(FoldmillError, ValueError):
    """A value that cannot be worked with."""


class InvalidPattern(InvalidInput):
    """Vertices, edges and faces that do not make a crease pattern."""


class InvalidParameters(InvalidInput):
    """Parameters outside their bounds, or contradicting each other."""


class ImpossibleGeometry(InvalidInput):
    """Legal parameters for which no folded form exists."""


class NoCandidate(ImpossibleGeometry):
    """A point of the strip that has no place in space: its circles do not meet."""

    def __init__(self, message: str, point: int) -> None:
        super().__init__(message)
        self.point = point
        """The number i of the point."""

    def __reduce__(self) -> tuple[type[NoCandidate], tuple[str, int]]:
        return type(self), (str(self), self.point)


class UnreadableFile(InvalidInput):
    """A file that cannot be read as what it claims to be."""


_FEW = 5
"""Names that are read at a glance; among more of them the nearest is named."""


class UnknownName(FoldmillError, LookupError):
    """A name that nobody offers."""

    @classmethod
    def of(cls, kind: str, name: str, known: Iterable[object]) -> UnknownName:
        """Say which names there are, and which is near, so that the next try succeeds."""
        from difflib import get_close_matches

        names = sorted(str(each) for each in known)
        near = get_close_matches(name, names, 1) if len(names) > _FEW else []
        meant = f" Did you mean {near[0]!r}?" if near else ""
        return cls(f"There is no {kind} {name!r}. There are: {', '.join(names) or 'none'}.{meant}")


class PluginFault(FoldmillError, TypeError):
    """A plugin that does not keep its contract."""


class BrokenBatch(PluginFault):
    """A batch that returns what no batch may return, so that none of its rows can be believed."""


def one_line(error: BaseException) -> str:
    """Return an exception's kind and words on one line: "TypeError: no list"."""
    return f"{type(error).__name__}: {' '.join(str(error).split())}"
