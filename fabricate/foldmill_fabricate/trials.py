"""A test cut made ready: planned in the waste of a job's own sheet, written, and proved."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

from foldmill.finding import Severity
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Face, Plan, ProgramFile, SetUp
from foldmill_fabricate.plan.trial import trial
from foldmill_fabricate.plotter.ledger import Answered
from foldmill_fabricate.sending import Job
from foldmill_fabricate.verify.trial import prove_trial

BEGUN = "test-cut-begun"
"""What the ledger calls a test cut of which a byte may have left."""
JUDGED = "test-cut"
"""What it calls what a person has said of one, or that none is wanted."""

BAD = (
    "The test cut for {} is not as it should be, and nothing of the part is cut with that setting. "
    "Set exposure or force, or change the preset and plan again; then send again."
)


def are_offered(plan: Plan) -> bool:
    """Tell whether a test cut can be laid in the waste.

    A coupon is one itself; what goes on with a sheet was tried when that was begun; and of a
    foreign drawing nobody knows what is waste.
    """
    return plan.coupon is None and plan.remakes is None and plan.source is None


def first_of_its_process(plan: Plan, setup: SetUp) -> bool:
    """Tell whether no set-up before this one goes the same way about it."""
    every = [one for work in plan.passes for one in work.setups]
    return next(one for one in every if one.process == setup.process).number == setup.number


def begun(answers: Iterable[Answered], setup: SetUp) -> int:
    """Return how many test cuts for a set-up may be in the waste of a sheet; each has its place.

    What was begun before a crash counts: cut again, it would be deeper than the part becomes.
    """
    return sum(one.gate == BEGUN and one.told["set-up"] == setup.name for one in answers)


def trial_program(job: Job, face: Face, setup: SetUp, attempt: int = 0) -> bytes:
    """Return the program of a test cut for a set-up, proved.

    attempt : 0, 1, 2 …, for a sheet in which some are cut already. Raises CannotPlan where the
    waste has no room, CannotSend where the program does not verify.
    """
    plan = trial(job.plan, job.pattern, face, setup, attempt)
    (own,) = plan.passes[0].setups
    fit = job.fit.fit if job.fit else None
    data = hpgl.program(plan, [own.number], fit)
    name = f"{own.name}.hpgl"
    digest = hashlib.sha256(data).hexdigest()
    file = ProgramFile(name=name, face=face, setups=(own.number,), sha256=digest)
    recorded = plan.model_copy(update={"programs": (file,)})
    findings = prove_trial(recorded, job.plan, job.pattern, name, data, fit)
    errors = [each for each in findings if each.severity is Severity.ERROR]
    if errors:
        raise CannotSend(f"The test cut is not sent, for it does not verify: {errors[0]}")
    return data
