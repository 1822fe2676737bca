"""Plans by the digest of what they are made from: begun, waited for, kept."""

from __future__ import annotations

import asyncio
import hashlib
import json
import shutil
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from foldmill import FoldmillError, installed
from foldmill.errors import InvalidInput, UnknownName
from foldmill_fabricate import profiles, shelf
from foldmill_fabricate.confining import PLANNING
from foldmill_fabricate.foreign import Asked
from foldmill_fabricate.hooks import FORMATS
from foldmill_fabricate.jobs.errors import NoSuchJob
from foldmill_fabricate.jobs.plans import Plans as Kept
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.service.desk import DRAWN, Desk
from foldmill_fabricate.service.models import KeptPlan, PlanRequest, PlanState, PlanStatus
from foldmill_fabricate.service.names import JOB, PATTERN
from foldmill_fabricate.service.problems import LOG, NoSuch
from foldmill_fabricate.service.sandbox import SandboxFailed, TooBusy
from foldmill_fabricate.service.storage import DONE, REFUSED, REQUEST, read, write
from foldmill_fabricate.space import DiskFull, keeping
from foldmill_fabricate.writers import usual_formats

_INTERRUPTED = "The service ended while this was planned; send the request again."


@dataclass(frozen=True)
class _Order:
    """Everything that a plan is made from."""

    pattern: str
    material: Material
    machine: Machine
    options: dict[str, Any]
    formats: tuple[str, ...]
    profile: str

    @property
    def arguments(self) -> dict[str, Any]:
        """What the sandbox is given."""
        plain = {
            "material": self.material.model_dump(mode="json"),
            "machine": self.machine.model_dump(mode="json"),
        }
        rest = {"options": self.options, "formats": self.formats, "profile": self.profile}
        return {**plain, **rest}

    @property
    def digest(self) -> str:
        """The plan's id: the same for the same, whoever asks and whenever."""
        whole = [version("foldmill"), self.pattern, self.arguments]
        return hashlib.sha256(json.dumps(whole, sort_keys=True).encode()).hexdigest()

    @property
    def head(self) -> dict[str, str]:
        """What is told of it from the beginning."""
        slugs = {"material": self.material.slug, "machine": self.machine.slug}
        return {"pattern": self.pattern, **slugs}


class Plans:
    """The plans of one service; what is done is kept where jobs find it."""

    def __init__(self, desk: Desk, kept: Kept) -> None:
        self._desk, self._storage, self._kept = desk, desk.storage, kept
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._full: dict[str, str] = {}
        """What is said of plans for which there was no room."""

    async def begin(self, request: PlanRequest) -> PlanStatus:
        """Begin a plan, unless it is there or on its way.

        Raises InvalidInput, UnknownName, NoSuch for the pattern, or what making the design raises.
        """
        order = await self._ordered(request)
        digest = order.digest
        place = await asyncio.to_thread(self._storage.begin_plan, digest, order.head)
        await asyncio.to_thread(self._forget_lost, place)
        if digest not in self._tasks and not (place / DONE).is_file():
            task = asyncio.create_task(self._make(digest, order))
            task.add_done_callback(_looked_at)
            self._tasks[digest] = task
            await asyncio.sleep(0)  # as far as into the queue, if there is room
            if task.done() and task.exception() is not None:
                raise task.exception() or AssertionError
        return await asyncio.to_thread(self.status, digest)

    def _forget_lost(self, place: Path) -> None:
        """Forget that a plan is done where its job folder is gone; else ask for that folder."""
        try:
            if (place / DONE).is_file():
                self._kept.folder(read(place / DONE)["plan"])
        except NoSuchJob:
            (place / DONE).unlink()

    def status(self, digest: str) -> PlanStatus:
        """Return how a plan stands; raises NoSuch."""
        return self._status(digest, self._storage.plan(digest))

    def _status(self, digest: str, place: Path) -> PlanStatus:
        head = {"id": digest, **read(place / REQUEST)}
        if (place / DONE).is_file():
            return PlanStatus.model_validate({**head, **read(place / DONE), "state": "done"})
        if digest in self._tasks:
            return PlanStatus.model_validate({**head, "state": PlanState.WAITING})
        if (place / REFUSED).is_file():
            return PlanStatus.model_validate({**head, **read(place / REFUSED), "state": "refused"})
        return PlanStatus.model_validate(
            {**head, "state": PlanState.INTERRUPTED, "detail": self._full.get(digest, _INTERRUPTED)}
        )

    def every(self) -> list[PlanStatus]:
        """Return all plans, by id."""
        found = []
        for digest, place in self._storage.plans():
            with suppress(FileNotFoundError):  # thrown away meanwhile
                found.append(self._status(digest, place))
        return found

    def job(self, digest: str) -> Path:
        """Return the job folder of a plan that is done; raises NoSuch where there is none."""
        status = self.status(digest)
        if status.state is not PlanState.DONE:
            raise NoSuch(f"The plan {digest} has no files: it is {status.state}. {status.detail}")
        return self._kept.folder(status.plan)

    async def keep(self, folder: Path) -> KeptPlan:
        """Prove and keep the job folder that a folder holds as the ZIP file ``upload``."""
        said = await self._desk.call("unpack", {}, folder, PLANNING, "The job folder")
        plan = await asyncio.to_thread(self._kept.keep, folder / JOB)
        return KeptPlan.model_validate({**said, "plan": plan})

    async def draw(self, folder: Path, asked: Asked) -> KeptPlan:
        """Plan, prove and keep the HP-GL drawing that a folder holds as the file ``upload``.

        Raises UnknownName for a material or machine, or what the sandbox refuses.
        """
        of, on = shelf.material(asked.material), shelf.machine(asked.machine)
        said = asked.model_dump(mode="json")
        presets = {"material": of.model_dump(mode="json"), "machine": on.model_dump(mode="json")}
        arguments = {"asked": said, **presets}
        told = await self._desk.call("drawn", arguments, folder, DRAWN, "The drawing")
        plan = await asyncio.to_thread(self._kept.keep, folder / JOB)
        return KeptPlan.model_validate({**told, "plan": plan})

    def file(self, digest: str, name: str) -> Path:
        """Return a file of a plan by the name that its status tells; raises NoSuch."""
        place, known = self.job(digest), {row.name for row in self.status(digest).files}
        if name not in known:
            raise NoSuch(f"{UnknownName.of('file', name, known)}")
        return place / name

    async def finish(self) -> None:
        """Let go of what is under way."""
        for task in [*self._tasks.values()]:
            task.cancel()
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)

    async def _ordered(self, request: PlanRequest) -> _Order:
        if (request.pattern is None) == (request.design is None):
            raise InvalidInput("Name a pattern by its id, or a design: one of both.")
        of, on = shelf.material(request.material), shelf.machine(request.machine)
        formats = request.formats or usual_formats(on)
        for slug in formats:
            installed().get(FORMATS, "format", slug)
        if request.profile not in profiles.names():  # a name, never a file
            raise UnknownName.of("profile of drawings", request.profile, profiles.names())
        if request.design is not None:
            pattern = (await self._desk.design(request.design)).id
        else:
            pattern = (await asyncio.to_thread(self._desk.pattern, str(request.pattern))).id
        options = request.options.model_dump(mode="json")
        return _Order(pattern, of, on, options, tuple(dict.fromkeys(formats)), request.profile)

    async def _make(self, digest: str, order: _Order) -> None:
        """Make a plan; whatever becomes of it is kept in its folder."""
        place = self._storage.plan(digest)
        self._full.pop(digest, None)
        try:
            with keeping(place):
                await self._carry_out(place, order)
        except TooBusy as error:
            self._full[digest] = str(error)
            raise  # it was not begun
        except DiskFull as error:
            LOG.error("plan %s: %s", digest, error)
            self._full[digest] = f"{error} Then ask for it again."
        except FoldmillError as error:
            if isinstance(error, SandboxFailed):
                LOG.error("plan %s: %s", digest, error, extra={"log": error.log})
            write(place / REFUSED, {"detail": str(error)})
        finally:
            self._tasks.pop(digest, None)

    async def _carry_out(self, place: Path, order: _Order) -> None:
        """Plan in a folder of its own, and keep what comes of it."""
        async with self._desk.folder() as folder:
            source = self._storage.pattern(order.pattern) / PATTERN
            await asyncio.to_thread(shutil.copy, source, folder)
            said = await self._desk.call("plan", order.arguments, folder, PLANNING, "The plan")
            plan = await asyncio.to_thread(self._kept.keep, folder / JOB)
        write(place / DONE, {**said, "plan": plan})


def _looked_at(task: asyncio.Task[None]) -> None:
    """Take note of how a plan's making ended; who asks how it stands is told."""
    if not task.cancelled():
        task.exception()
