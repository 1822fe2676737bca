"""Plan the rest of a sheet: the strokes that are missing, placed and registered as the others."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from foldmill.finding import Finding, Severity
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.materials import Perforation
from foldmill_fabricate.passes import (
    Face,
    Fit,
    Gate,
    Operation,
    Pass,
    Plan,
    Remakes,
    SetUp,
    There,
)
from foldmill_fabricate.plan.figures import measure
from foldmill_fabricate.plan.setups import gates
from foldmill_fabricate.plotter.ledger import SheetRecord, State
from foldmill_fabricate.remaking.strokes import Account, Standing, accounts
from foldmill_fabricate.remaking.words import Fate, Fates, Spoken, listed, settled

_LEFT = frozenset({State.INTERRUPTED, State.UNCONFIRMED, State.SPOILED})


def remake(
    plan: Plan, sheet: SheetRecord, said: Iterable[Spoken] = (), fit: Fit | None = None
) -> Plan:
    """Return the plan of what is missing on a sheet that was begun from ``plan``.

    said : of every stroke in doubt, whether it is cut; fit : how the reverse lay, where it was
    fitted to marks. Raises CannotPlan for a sheet that is not given up or interrupted, another
    job's sheet, one on which nothing is missing, a stroke in doubt of which nothing is said, and a
    half-cut score, which would get deeper.
    """
    found = accounts(plan, sheet, fit)
    _refuse_state(sheet)
    fates = settled(sheet, found, said)
    there = [account for account in found if _is_there(plan, sheet, account, fates)]
    if len(there) == len(found):
        raise CannotPlan(f"Nothing is missing on sheet {sheet.id}: all its strokes are cut.")
    return _planned(plan, sheet, there, len(found))


def _refuse_state(sheet: SheetRecord) -> None:
    """Refuse a sheet that is being made, that is still to be gone on with, or that is done."""
    states = {record.state for record in sheet.records}
    if not sheet.is_begun:
        raise CannotPlan(f"Nothing is cut on sheet {sheet.id} yet: send the folder as it is.")
    if State.RUNNING in states:
        raise CannotPlan(
            f"Sheet {sheet.id} is being made, or what made it was killed. Wait for its end; after "
            "a kill, send it once more, which tells how it stands and cuts nothing unasked; or "
            f"give it up with foldmill sheets {sheet.id} --spoiled."
        )
    if states == {State.DONE}:
        raise CannotPlan(f"Nothing is missing on sheet {sheet.id}: all of it is done.")
    if not states & _LEFT:
        raise CannotPlan(
            f"Sheet {sheet.id} was neither interrupted nor given up: go on with it by foldmill "
            f"send --sheet {sheet.id}, or give it up with foldmill sheets {sheet.id} --spoiled."
        )


def _is_there(plan: Plan, sheet: SheetRecord, account: Account, fates: Fates) -> bool:
    """Tell whether a stroke is cut; raises CannotPlan for half a score."""
    own = {
        stroke: _fate(fates, account.program, stroke, stands)
        for stroke, stands in account.standings.items()
    }
    known = {*own.values()}
    if known <= {Fate.CUT}:
        return True
    if known == {Fate.MISSING} or _goes_through(plan, account.setup):
        return False
    name = sheet.records[account.program].program.name
    kind = "groove" if account.setup.process == "cut" else "score"
    raise CannotPlan(
        f"Stroke {listed(own)} of {name} is a {kind} and cut in part: made again, that part would "
        "be deeper than the rest. Where the sheet is not given up, go on inside that stroke with "
        f"foldmill send --sheet {sheet.id} --go-on STROKE.VERTEX; or finish it by hand, and say "
        "that it is cut."
    )


def _goes_through(plan: Plan, setup: SetUp) -> bool:
    """Tell whether a set-up parts the sheet: cut again, it gets no deeper."""
    if setup.process == "cut":
        return plan.material.cut.goes_through
    return isinstance(plan.material.score, Perforation)


def _fate(fates: Fates, program: int, stroke: int, stands: Standing) -> Fate:
    if stands is Standing.CERTAIN:
        return Fate.CUT
    return Fate.MISSING if stands is Standing.LEFT else fates[program, stroke]


def _planned(plan: Plan, sheet: SheetRecord, there: Sequence[Account], of: int) -> Plan:
    declared = _declared(there)
    passes = tuple(_passes(plan, {(one.setup, one.role): one.strokes for one in declared}))
    remakes = Remakes(
        sheet=sheet.id,
        origin=plan,
        origin_sha256=plan.digest,
        record_sha256=sheet.digest,
        there=declared,
    )
    text = f"It goes on with sheet {remakes.written}: {len(there)} of {of} strokes are there."
    return plan.model_copy(
        update={
            "title": f"{plan.whole.title}, rest of sheet {remakes.written}".lstrip(", "),
            "remakes": remakes,
            "passes": passes,
            "figures": measure(passes, plan.machine, plan.sheet, plan.flip),
            "findings": (*plan.findings, Finding("remakes", Severity.INFO, "plan", text)),
            "programs": (),
            "drawings": (),
        }
    )


def _declared(there: Sequence[Account]) -> tuple[There, ...]:
    groups: dict[tuple[int, str], list[Account]] = {}
    for account in there:
        groups.setdefault((account.setup.number, account.role), []).append(account)
    return tuple(
        There(setup=own[0].setup.number, role=own[0].role, strokes=tuple(a.number for a in own))
        for own in groups.values()
    )


def _passes(plan: Plan, there: dict[tuple[int, str], tuple[int, ...]]) -> Iterator[Pass]:
    """Yield the passes without what is there, set-ups numbered anew."""
    number = 0
    before: tuple[Face, SetUp] | None = None
    for work in plan.passes:
        kept: list[SetUp] = []
        for setup in work.setups:
            operations = tuple(_operations(setup, there))
            if not operations:
                continue
            number += 1
            due = _gates(before, work.face, setup, plan)
            changed = {"number": number, "gates": due, "operations": operations}
            kept.append(setup.model_copy(update=changed))
            before = (work.face, setup)
        if kept:
            yield Pass(face=work.face, setups=tuple(kept))


def _operations(setup: SetUp, there: dict[tuple[int, str], tuple[int, ...]]) -> Iterator[Operation]:
    for operation in setup.operations:
        cut = {*there.get((setup.number, operation.role), ())}
        left = tuple(s for k, s in enumerate(operation.strokes, 1) if k not in cut)
        if left:
            yield operation.model_copy(update={"strokes": left})


def _gates(
    before: tuple[Face, SetUp] | None, face: Face, setup: SetUp, plan: Plan
) -> tuple[Gate, ...]:
    """The sheet is not loaded new, it comes back: it must lie as it lay."""
    changes = before is not None and before[1].process != setup.process
    asked = gates(before[0] if before else None, face, changes, plan.machine)
    return tuple(Gate.RE_REGISTER if gate is Gate.LOAD else gate for gate in asked)
