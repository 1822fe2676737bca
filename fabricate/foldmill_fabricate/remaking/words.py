"""What a person says of the strokes in doubt, once they have looked at the sheet."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.plotter.ledger import SheetRecord
from foldmill_fabricate.remaking.strokes import Account, Standing, in_doubt


class Fate(StrEnum):
    """What a stroke in doubt turned out to be."""

    CUT = "cut"
    MISSING = "missing"
    HALF = "half"
    """cut in part"""


Fates = Mapping[tuple[int, int], Fate]
"""By program and stroke, as the ledger counts them from 0."""


@dataclass(frozen=True)
class Spoken:
    """What was said of strokes in doubt of one program."""

    fate: Fate
    strokes: frozenset[int] | None = None
    """From 0; None for all that are in doubt."""
    rest: Fate | None = None
    """What all others in doubt are; None where nothing was said of them."""
    program: str = ""
    """Its name; empty where only one has strokes in doubt."""


def read_spoken(text: str, fate: Fate = Fate.MISSING) -> Spoken:
    """Read "cut", "missing", or the numbers of strokes from 1 on, such as "3,5-8".

    With numbers, those have that fate, and all others in doubt are cut; of half-cut strokes nothing
    follows for others. "NAME:" before it names the program. Raises CannotPlan.
    """
    program, _, said = text.strip().rpartition(":")
    if said in {Fate.CUT.value, Fate.MISSING.value} and fate is not Fate.HALF:
        return Spoken(Fate(said), program=program)
    rest = None if fate is Fate.HALF else Fate.CUT
    return Spoken(fate, frozenset(_numbers(said)), rest, program)


def _numbers(text: str) -> list[int]:
    found: list[int] = []
    for piece in text.split(","):
        match = re.fullmatch(r"\s*(\d{1,7})\s*(?:-\s*(\d{1,7})\s*)?", piece)
        low = int(match[1]) if match else 0
        high = int(match[2] or low) if match else 0
        if not 1 <= low <= high or high - low > 100_000:
            raise CannotPlan(
                f"{text!r} names no strokes: say cut, missing, or those that are missing, such as "
                "3,5-8."
            )
        found += range(low - 1, high)
    return found


def settled(sheet: SheetRecord, found: Sequence[Account], said: Iterable[Spoken]) -> Fates:
    """Return the fate of every stroke in doubt.

    Raises CannotPlan where nothing was said of one, and for words that are about no stroke in doubt
    or contradict each other.
    """
    doubts = in_doubt(sheet, found)
    fates: dict[tuple[int, int], Fate] = {}
    follows: dict[tuple[int, int], Fate] = {}
    for one in said:
        number = _program(sheet, doubts, one)
        own = {*doubts.get(number, {})}
        _refuse_strangers(sheet, number, own, one)
        for stroke in own if one.strokes is None else one.strokes:
            if fates.setdefault((number, stroke), one.fate) is not one.fate:
                name = sheet.records[number].program.name
                raise CannotPlan(f"Stroke {stroke + 1} of {name} is said to be two things.")
        follows |= {(number, stroke): one.rest for stroke in own if one.rest}
    fates = follows | fates
    _refuse_silence(sheet, doubts, fates)
    return {key: _certain(doubts, key, fate) for key, fate in fates.items()}


def _certain(
    doubts: Mapping[int, Mapping[int, Standing]], key: tuple[int, int], fate: Fate
) -> Fate:
    """A stroke that was cut up to a vertex is cut in part at least, whatever is said of it."""
    known = doubts[key[0]][key[1]]
    return Fate.HALF if fate is Fate.MISSING and known is Standing.HALF else fate


def _program(sheet: SheetRecord, doubts: Mapping[int, Mapping[int, Standing]], one: Spoken) -> int:
    names = {record.program.name: record.number for record in sheet.records}
    if one.program:
        if one.program not in names:
            raise CannotPlan(
                f"Sheet {sheet.id} has no program {one.program!r}. It has: {', '.join(names)}."
            )
        return names[one.program]
    if len(doubts) > 1:
        found = ", ".join(sheet.records[number].program.name for number in doubts)
        raise CannotPlan(
            f"More than one program has strokes in doubt: {found}. Say of which, such as "
            f"{sheet.records[min(doubts)].program.name}:missing."
        )
    return next(iter(doubts), 0)


def _refuse_strangers(sheet: SheetRecord, number: int, own: set[int], one: Spoken) -> None:
    strangers = sorted((one.strokes or frozenset()) - own)
    if not strangers and (own or one.strokes is None):
        return
    record = sheet.records[number]
    told = f"In doubt are {listed(own)}." if own else "None of its strokes is in doubt."
    raise CannotPlan(
        f"Nothing can be said of strokes {listed(strangers)} of {record.program.name}: what the "
        f"machine confirmed is cut, and what was never sent is missing. {told}"
    )


def _refuse_silence(
    sheet: SheetRecord, doubts: Mapping[int, Mapping[int, Standing]], fates: Fates
) -> None:
    silent = {
        number: [stroke for stroke in strokes if (number, stroke) not in fates]
        for number, strokes in doubts.items()
    }
    told = [
        f"{sheet.records[number].program.name}: {listed(strokes)}"
        for number, strokes in silent.items()
        if strokes
    ]
    if told:
        raise CannotPlan(
            f"On sheet {sheet.id} these strokes may be cut or not: {'; '.join(told)}. Look at the "
            "sheet, and say --doubtful cut, --doubtful missing, or the numbers of those that are "
            "missing, such as --doubtful 3,5-8."
        )


def listed(strokes: Iterable[int]) -> str:
    """Write the numbers of strokes for people, from 1 on, spans joined: "3, 5-8"."""
    spans: list[list[int]] = []
    for stroke in sorted(strokes):
        if spans and spans[-1][1] == stroke - 1:
            spans[-1][1] = stroke
        else:
            spans.append([stroke, stroke])
    return ", ".join(f"{a + 1}" if a == b else f"{a + 1}-{b + 1}" for a, b in spans)
