"""Which programs there are, which files they read, and what those cannot hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from foldmill import Fold
from foldmill.exchange import cp, opx, portable
from foldmill_fabricate.exporting import losses
from foldmill_fabricate.exporting.losses import Loss
from foldmill_fabricate.pictures.pattern_svg import FLAT_FOLDER, pattern_svg


@dataclass(frozen=True)
class Writer:
    """One kind of file that a program reads."""

    write: Callable[[Fold], bytes]
    losses: tuple[Loss, ...] = ()
    """What such a file cannot hold."""


@dataclass(frozen=True)
class Program:
    """A program that patterns are written for."""

    slug: str
    title: str
    files: Mapping[str, Writer]
    """By suffix, such as ``.fold``; the one that holds most comes first."""


def _text(write: Callable[[Fold], str]) -> Callable[[Fold], bytes]:
    return lambda fold: write(fold).encode()


_FLAT_FOLD = Writer(_text(portable.flat), (losses.angles,))

_LINES = (losses.angles, losses.cuts, losses.mark, losses.near(1.0))
"""What lines of four types do not hold; a unit is a mm, so that the size comes back."""

_ALL = (
    Program(
        "origami-simulator",
        "Origami Simulator: folds a pattern step by step, by its angles",
        {
            ".fold": Writer(_text(portable.spatial)),
            ".svg": Writer(pattern_svg),
        },
    ),
    Program(
        "flat-folder",
        "Flat-Folder: finds every order of layers of a pattern folded flat",
        {
            ".fold": Writer(_text(portable.flat), (losses.angles,)),
            ".svg": Writer(
                lambda fold: pattern_svg(fold, FLAT_FOLDER), (losses.angles, losses.cuts)
            ),
        },
    ),
    Program(
        "oripa",
        "ORIPA: draws patterns that fold flat, and folds them",
        {".opx": Writer(_text(opx.write), _LINES), ".cp": Writer(_text(cp.write), _LINES)},
    ),
    Program(
        "oriedita",
        "Oriedita: draws patterns that fold flat",
        {
            ".fold": Writer(_text(portable.downward), (losses.angles, losses.unassigned)),
            ".cp": Writer(_text(cp.write), _LINES),
        },
    ),
    Program(
        "rabbit-ear",
        "Rabbit Ear and other libraries that check a file before they use it",
        {".fold": Writer(_text(portable.plain))},
    ),
    Program(
        "fold-1.2",
        "FOLD 1.2 by the letter, with inner cuts (C) and joins (J)",
        {".fold": Writer(_text(portable.strict))},
    ),
)

PROGRAMS: Mapping[str, Program] = {program.slug: program for program in _ALL}
"""All programs, by slug."""
