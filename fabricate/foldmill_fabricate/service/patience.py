"""How long a connection may keep its place without saying or hearing anything.

There are so many places, and a stranger without a token could take them all: a connection that
never sends the head of a request, one whose body never ends, one that asks for a large file and
reads none of it. Each is let go, so that whoever stands at a machine is heard.
"""

from __future__ import annotations

import asyncio

from starlette.exceptions import HTTPException
from starlette.types import Message, Receive
from uvicorn.protocols.http.h11_impl import H11Protocol

HEAD = 20.0
"""s for the head of a request, from its connection or its first byte on."""
BODY = 60.0
"""s for a body to arrive."""
READING = 60.0
"""s in which whoever is answered reads something."""


class Patient(H11Protocol):
    """A connection that is closed where no request comes of it, or nobody reads its answer."""

    _head_late: asyncio.TimerHandle | None = None
    _reading_late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for the head of its first request."""
        super().connection_made(transport)
        self._expect_head()

    def data_received(self, data: bytes) -> None:
        """Read on, and wait for the head of a request where none is under way."""
        super().data_received(data)
        self._expect_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait for nothing any more."""
        _stop(self._head_late)
        _stop(self._reading_late)
        super().connection_lost(exc)

    def pause_writing(self) -> None:
        """Take note that so much is unread that no more is written."""
        super().pause_writing()
        self._reading_late = self.loop.call_later(READING, self.transport.abort)

    def resume_writing(self) -> None:
        """Take note that some of it was read."""
        _stop(self._reading_late)
        super().resume_writing()

    def _expect_head(self) -> None:
        """Begin to wait where a request is to come, and no more where one has; bytes win no time.

        What comes of a body after its answer counts as nothing.
        """
        if self._is_answering:
            _stop(self._head_late)
            self._head_late = None
        elif self._head_late is None:
            self._head_late = self.loop.call_later(HEAD, self._give_up)

    @property
    def _is_answering(self) -> bool:
        return self.cycle is not None and not self.cycle.response_complete

    def _give_up(self) -> None:
        self._head_late = None
        if not self._is_answering:
            self.transport.close()


def _stop(timer: asyncio.TimerHandle | None) -> None:
    if timer is not None:
        timer.cancel()


class InTime:
    """Receives a body, all of it in time."""

    def __init__(self, receive: Receive) -> None:
        self._receive, self._end, self._is_whole = receive, 0.0, False

    async def __call__(self) -> Message:
        """Return the next part; raises HTTPException 408 where it is late."""
        if self._is_whole:
            return await self._receive()
        self._end = self._end or asyncio.get_running_loop().time() + BODY
        try:
            async with asyncio.timeout_at(self._end):
                message = await self._receive()
        except TimeoutError:
            raise HTTPException(408, f"The body had not arrived after {BODY:g} s.") from None
        self._is_whole = not message.get("more_body", False)
        return message
