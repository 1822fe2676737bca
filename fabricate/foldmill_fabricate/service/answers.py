"""What the client makes of answers: refusals as the errors they are, events as they come."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar
from urllib.parse import quote

import httpx
from pydantic import TypeAdapter, ValidationError

from foldmill.errors import FoldmillError, InvalidInput
from foldmill.refusals import explain
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.jobs.errors import NoSuchJob
from foldmill_fabricate.jobs.values import Event
from foldmill_fabricate.service.models import PlanState, PlanStatus, PlotterStatus
from foldmill_fabricate.service.urns import urn

T = TypeVar("T")
_EVENTS = "/api/v1/events"
_AGAIN = 0.5
"""s before a connection that broke is made again."""


class ServiceRefused(FoldmillError, RuntimeError):
    """A refusal of the service that has no class of its own here."""


class Unreachable(FoldmillError, OSError):
    """A service that does not answer."""


def quoted(part: str) -> str:
    """Return a name as one part of a path; raises InvalidInput for what cannot be one."""
    if part in {"", ".", ".."}:
        raise InvalidInput(f"{part!r} names nothing; give the id or the name as the service told.")
    try:
        return quote(part, safe="")
    except UnicodeError:
        raise InvalidInput(f"{part!r} is no text in UTF-8.") from None


def asked(http: httpx.Client, method: str, path: str, **how: Any) -> httpx.Response:
    """Return an answer; raises the error that the service tells of, or Unreachable.

    InvalidInput is raised for what cannot be sent.
    """
    try:
        answer = http.request(method, path, **how)
    except UnicodeError:
        raise InvalidInput("This holds letters that are no text in UTF-8.") from None
    except httpx.HTTPError as error:
        raise unreachable(str(http.base_url), error) from None
    if not answer.is_success:
        raise refusal(answer)
    return answer


def refusal(answer: httpx.Response) -> FoldmillError:
    """Return the error that an answer tells of, with the service's sentence."""
    try:
        told = answer.json()
        kind, detail = str(told["type"]), str(told["detail"])
    except (ValueError, KeyError, TypeError):
        return ServiceRefused(f"The service answers {answer.status_code} and says no more.")
    for each in _kinds(FoldmillError):
        if urn(each.__name__) == kind:
            try:
                return each(detail)
            except TypeError:  # it wants to know more than a sentence
                break
    return ServiceRefused(detail)


def address(url: str) -> str:
    """Return the address of a service without a last slash; raises InvalidInput for none."""
    plain = url.strip().rstrip("/")
    try:
        known = httpx.URL(plain)
    except (httpx.InvalidURL, UnicodeError):
        known = httpx.URL("")
    if known.scheme not in {"http", "https"} or not known.host:
        raise InvalidInput(
            f"{url[:80]!r} is no address of a service: write it as http://127.0.0.1:8765."
        )
    return plain


def bearer(token: str) -> dict[str, str]:
    """Return the header that a token travels in, none for none; raises InvalidInput."""
    plain = token.strip()
    if not (plain.isascii() and plain.isprintable() and " " not in plain):
        raise InvalidInput(
            "This is no token: one is letters, digits, - and _ on one line, as foldmill serve "
            "--new-token told it."
        )
    return {"authorization": f"Bearer {plain}"} if plain else {}


def unreachable(url: str, error: httpx.HTTPError) -> Unreachable:
    """Return the sentence on a service that does not answer."""
    why = str(error).rstrip(".") or type(error).__name__
    return Unreachable(f"The service at {url} does not answer: {why}. Does foldmill serve run?")


def understood(kind: type[T], content: bytes | str, url: str) -> T:
    """Return an answer as a value; raises ServiceRefused for one of another version's."""
    try:
        return TypeAdapter(kind).validate_json(content)
    except ValidationError as error:
        raise ServiceRefused(
            f"The service at {url} answers what this version of foldmill does not understand: "
            f"{explain(error)} Is it of the same version? Ask its /api/v1."
        ) from None


def done(status: PlanStatus) -> PlanStatus:
    """Return a plan that is done; raises CannotPlan with the sentence for any other."""
    if status.state is not PlanState.DONE:
        raise CannotPlan(status.detail)
    return status


def named(plotters: Iterable[PlotterStatus], name: str) -> PlotterStatus:
    """Return a plotter; raises NoSuchJob with the names there are."""
    known = {plotter.name: plotter for plotter in plotters}
    if name not in known:
        there = ", ".join(known) or "none: name them where the service runs"
        raise NoSuchJob(f"There is no plotter {name[:40]!r}. There are: {there}.")
    return known[name]


def follow(
    http: httpx.Client, after: int, job: str, patience: float, tell: Callable[[Any], None]
) -> Iterator[Event]:
    """Yield events without end, over as many connections as it takes."""
    heard_at = time.monotonic()
    while True:
        try:
            for kind, data in _stream(http, after, job):
                heard_at = time.monotonic()
                if kind == "job":
                    event = understood(Event, data, str(http.base_url))
                    after = event.number
                    yield event
                elif kind == "progress":
                    tell(understood(list[Any], data, str(http.base_url)))
        except httpx.HTTPError as error:
            if time.monotonic() - heard_at > patience:
                raise unreachable(str(http.base_url), error) from None
            time.sleep(_AGAIN)


def _stream(http: httpx.Client, after: int, job: str) -> Iterator[tuple[str, str]]:
    """Yield (event, data) of one connection; raises HTTPError where it breaks."""
    headers = {"last-event-id": str(after)} if after else {}
    silence = httpx.Timeout(60.0)  # a living service sends a comment every 15 s
    asked = {"job": job}
    with http.stream("GET", _EVENTS, params=asked, headers=headers, timeout=silence) as answer:
        if not answer.is_success:
            answer.read()
            if answer.status_code == 503:
                raise httpx.ReadError("it is full, or ending")
            raise refusal(answer)
        yield "open", ""
        yield from events(answer.iter_lines())


def events(lines: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Yield (event, data) of server-sent events; comments, ids and retries are left out."""
    kind = "message"
    data: list[str] = []
    for line in lines:
        name, _, value = line.partition(":")
        if not line:
            if data:
                yield kind, "\n".join(data)
            kind, data = "message", []
        elif name == "event":
            kind = value.removeprefix(" ")
        elif name == "data":
            data.append(value.removeprefix(" "))


def _kinds(root: type[FoldmillError]) -> Iterator[type[FoldmillError]]:
    for each in root.__subclasses__():
        yield each
        yield from _kinds(each)
