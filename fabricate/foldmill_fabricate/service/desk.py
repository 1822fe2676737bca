"""What the service does with patterns: everything that computes is done in the sandbox."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from foldmill_fabricate.confining import PLANNING, Limits
from foldmill_fabricate.plotter.ledger import SheetRecord
from foldmill_fabricate.service.models import (
    DesignRequest,
    Pattern,
    Report,
    Upload,
    Verification,
)
from foldmill_fabricate.service.names import AS_CUT, JOB, PATTERN
from foldmill_fabricate.service.sandbox import Sandbox
from foldmill_fabricate.service.storage import ABOUT, Storage, read, write

WORK = "foldmill_fabricate.service.work"
DRAWINGS = {
    "pattern.svg": "image/svg+xml",
    "pattern.png": "image/png",
    "folded.glb": "model/gltf-binary",
    "folded.stl": "model/stl",
    "folded.obj": "model/obj",
}
"""What a pattern can be drawn as, and its media type."""
_SHEET = TypeAdapter(SheetRecord)
CHECK, VERIFIED = "check.json", "verified.json"
READING = Limits(seconds=30, memory_mb=1024, file_mb=128)
DESIGNING = Limits(seconds=60, memory_mb=1024, file_mb=128)
DRAWN = Limits(seconds=90, memory_mb=1024, file_mb=128)
"""Of an HP-GL drawing that is planned: who sends it waits for the answer."""


class Desk:
    """Patterns that are kept, and the sandbox in which they are made and looked at."""

    def __init__(self, storage: Storage, sandbox: Sandbox) -> None:
        self.storage, self.sandbox = storage, sandbox

    @asynccontextmanager
    async def folder(self) -> AsyncIterator[Path]:
        """Give a folder for one piece of work; what is left of it afterwards is thrown away.

        Threads make it and throw it away: a disk that is slow must not keep others waiting. Raises
        TooBusy at once where there is no room for more work, before anything is received for it.
        """
        self.sandbox.require_room()
        made = await asyncio.to_thread(self.sandbox.folder)
        try:
            yield made
        finally:
            await asyncio.to_thread(shutil.rmtree, made, ignore_errors=True)

    async def read(self, folder: Path, said: Upload) -> Pattern:
        """Keep the pattern in the file ``upload`` of a folder."""
        options = said.model_dump(mode="json")
        arguments = {"form": options.pop("form"), "options": options}
        return await self._keep("read", arguments, folder, READING, "The file")

    async def design(self, request: DesignRequest) -> Pattern:
        """Make a design and keep its pattern."""
        async with self.folder() as folder:
            arguments = request.model_dump(mode="json")
            return await self._keep("design", arguments, folder, DESIGNING, "The design")

    def pattern(self, digest: str) -> Pattern:
        """Return what is known of a pattern; raises NoSuch."""
        return Pattern.model_validate(read(self.storage.pattern(digest) / ABOUT))

    async def check(self, digest: str) -> Report:
        """Check a pattern; what was found is kept."""
        place = await asyncio.to_thread(self.storage.pattern, digest)
        source = place / PATTERN
        found = await self._once(place / CHECK, "check", source, PATTERN, "The check")
        return Report.model_validate(found)

    async def verify(self, digest: str, job: Path) -> Verification:
        """Verify the job folder of a plan; what was found is kept."""
        place = await asyncio.to_thread(self.storage.plan, digest)
        found = await self._once(place / VERIFIED, "verify", job, JOB, "The verification")
        return Verification.model_validate(found)

    async def drawing(self, digest: str, name: str) -> Path:
        """Return a drawing of a pattern, a name of ``DRAWINGS``; it is made once."""
        place = await asyncio.to_thread(self.storage.pattern, digest)
        if not (place / name).is_file():
            async with self.folder() as folder:
                await asyncio.to_thread(shutil.copy, place / PATTERN, folder)
                await self.call("draw", {"name": name}, folder, DESIGNING, "The drawing")
                (folder / name).replace(place / name)
        return place / name

    async def as_cut(self, job: Path, sheet: SheetRecord, face: str) -> bytes:
        """Return a drawing, SVG, of how a face of a sheet is cut by now; job : its job folder."""
        told = _SHEET.dump_python(sheet, mode="json")
        arguments = {"job": str(job), "face": face, "sheet": told}
        async with self.folder() as folder:
            await self.call("as_cut", arguments, folder, DESIGNING, "The drawing")
            return (folder / AS_CUT).read_bytes()

    async def call(
        self, name: str, arguments: Mapping[str, Any], folder: Path, limits: Limits, what: str
    ) -> Any:
        """Call a function of ``work`` in the sandbox and wait for its value."""
        return await asyncio.wrap_future(
            self.sandbox.submit(
                f"{WORK}:{name}", arguments, folder=folder, limits=limits, what=what
            )
        )

    async def _keep(
        self, name: str, arguments: Mapping[str, Any], folder: Path, limits: Limits, what: str
    ) -> Pattern:
        about = await self.call(name, arguments, folder, limits, what)
        await asyncio.to_thread(self.storage.keep_pattern, folder, about)
        return Pattern.model_validate(about)

    async def _once(self, kept: Path, name: str, source: Path, within: str, what: str) -> Any:
        """Return what was found before, or find it with a copy of what it is about."""
        if not kept.is_file():
            async with self.folder() as folder:
                copy = shutil.copytree if source.is_dir() else shutil.copy
                await asyncio.to_thread(copy, source, folder / within)
                write(kept, await self.call(name, {}, folder, PLANNING, what))
        return read(kept)
