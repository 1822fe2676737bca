"""Bodies that are files: written to disk as they arrive, and never held whole."""

from __future__ import annotations

import asyncio
from typing import BinaryIO

from fastapi import Request
from starlette.requests import ClientDisconnect

from foldmill_fabricate.service.bounds import MOST_UPLOAD
from foldmill_fabricate.service.problems import Forbidden, TooLarge

_PATIENCE = 60.0
"""s for a body to arrive."""
_AT_ONCE = 1 << 20
"""Bytes that are held until they are written, by a thread: a disk may be slow."""


async def receive(request: Request, file: BinaryIO, most: int = MOST_UPLOAD) -> None:
    """Write a body into a file as it arrives; most : bytes.

    Raises TooLarge, or Forbidden where it stalls.
    """
    count, held = 0, bytearray()
    try:
        async with asyncio.timeout(_PATIENCE):
            async for part in request.stream():
                count += len(part)
                if count > most:
                    raise TooLarge(f"The file is larger than {most:,} bytes.")
                held += part
                if len(held) >= _AT_ONCE:
                    await asyncio.to_thread(file.write, held)
                    held = bytearray()
        await asyncio.to_thread(file.write, held)
    except TimeoutError:
        raise Forbidden(f"The file had not arrived after {_PATIENCE:g} s.", 408) from None
    except ClientDisconnect:
        raise Forbidden("The file was cut off on its way.", 400) from None
