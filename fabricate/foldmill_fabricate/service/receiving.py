"""Bodies that are files: written to disk as they arrive, and never held whole."""

from __future__ import annotations

import asyncio
from pathlib import Path

from fastapi import Request
from starlette.requests import ClientDisconnect

from foldmill_fabricate.service.bounds import MOST_UPLOAD
from foldmill_fabricate.service.names import UPLOAD
from foldmill_fabricate.service.problems import Forbidden, TooLarge

_AT_ONCE = 1 << 20
"""Bytes that are held until they are written, by a thread: a disk may be slow."""


async def receive(request: Request, folder: Path, most: int = MOST_UPLOAD) -> None:
    """Write a body into the file ``upload`` of a folder as it arrives; most : bytes.

    Raises TooLarge, or Forbidden where it breaks off; how long it may take is ``patience``'s.
    """
    count, held = 0, bytearray()
    try:
        with (folder / UPLOAD).open("wb") as file:
            async for part in request.stream():
                count += len(part)
                if count > most:
                    raise TooLarge(f"The file is larger than {most:,} bytes.")
                held += part
                if len(held) >= _AT_ONCE:
                    await asyncio.to_thread(file.write, held)
                    held = bytearray()
            await asyncio.to_thread(file.write, held)
    except ClientDisconnect:
        raise Forbidden("The file was cut off on its way.", 400) from None
