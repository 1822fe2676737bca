"""Who may do what: tokens, of which only digests are kept.

A token is 256 random bits, so that its SHA-256 tells nothing of it and needs no salt. They lie in
``tokens.json`` of the service's folder, readable by its owner alone.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import re
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from enum import StrEnum
from pathlib import Path

from filelock import FileLock, Timeout

from foldmill.errors import InvalidInput, UnknownName, UnreadableFile
from foldmill_fabricate.files import write_whole

FILE = "tokens.json"
MARK = "foldmill_"
"""What each begins with, so that it is known wherever it stands."""
TOKEN = re.compile(rf"{MARK}[A-Za-z0-9_-]{{20,}}")
"""A token, or most of one."""
_PATIENCE = 10.0
"""s for which another may be at it."""
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,39}")


class Scope(StrEnum):
    """What a token allows; each allows what stands before it as well."""

    VIEW = "view"
    """look at everything"""
    SUBMIT = "submit"
    """make designs and plans, upload, submit jobs"""
    OPERATE = "operate"
    """answer gates, pause, resume and cancel: what makes a machine move"""

    def allows(self, other: Scope) -> bool:
        """Tell whether it allows what another does."""
        ranks = [*Scope]
        return ranks.index(self) >= ranks.index(other)


@dataclass(frozen=True)
class Token:
    """A token as it is kept."""

    name: str
    """Whose it is; every answer at a gate is signed with it."""
    scope: Scope
    sha256: str


class Tokens:
    """The tokens of one service; another process may change them meanwhile."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / FILE
        self._seen: tuple[int, int] | None = None
        self._kept: tuple[Token, ...] = ()

    @property
    def every(self) -> tuple[Token, ...]:
        """All tokens, by name; raises UnreadableFile where they cannot be read."""
        try:
            found = self._file.stat()
        except FileNotFoundError:
            self._kept, self._seen = (), None
            return ()
        now = found.st_mtime_ns, found.st_ino
        if now != self._seen:
            self._kept, self._seen = self._read(), now
        return self._kept

    def new(self, name: str, scope: Scope) -> str:
        """Make a token and return it; nobody can tell it again. Raises InvalidInput."""
        if not _NAME.fullmatch(name):
            raise InvalidInput(
                f"{name!r} is no name for a token: 1 to 40 letters, digits, dots and dashes."
            )
        secret = f"{MARK}{secrets.token_urlsafe(32)}"
        with self._alone():
            if any(token.name == name for token in self.every):
                raise InvalidInput(f"There is a token named {name!r}; revoke it first.")
            self._write([*self.every, Token(name, scope, _digest(secret))])
        return secret

    def revoke(self, name: str) -> None:
        """Let a token no longer count; raises UnknownName."""
        with self._alone():
            if not any(token.name == name for token in self.every):
                raise UnknownName.of("token", name, (token.name for token in self.every))
            self._write([token for token in self.every if token.name != name])

    def find(self, secret: str) -> Token | None:
        """Return the token of a secret; takes as long for a wrong one as for a right one."""
        digest, found = _digest(secret), None
        for token in self.every:
            if hmac.compare_digest(token.sha256, digest):
                found = token
        return found

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Keep others from changing them: what was revoked meanwhile must not be written back.

        Raises UnreadableFile where another does not let go of them.
        """
        self._file.parent.mkdir(parents=True, exist_ok=True)
        lock = FileLock(f"{self._file}.lock", timeout=_PATIENCE, mode=0o600)
        try:
            lock.acquire()
        except (Timeout, OSError) as error:
            raise UnreadableFile(
                f"{self._file} cannot be changed: {error}. Does another command do so, or another "
                "user? Try again when it has ended."
            ) from None
        with lock:
            yield

    def _read(self) -> tuple[Token, ...]:
        try:
            rows = json.loads(self._file.read_bytes())
            return tuple(Token(row["name"], Scope(row["scope"]), row["sha256"]) for row in rows)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise UnreadableFile(
                f"{self._file} holds no tokens ({type(error).__name__}); nobody is let in. Mend "
                "it, or remove it and make new ones."
            ) from None

    def _write(self, tokens: list[Token]) -> None:
        rows = [asdict(token) for token in sorted(tokens, key=lambda token: token.name)]
        write_whole(self._file, (json.dumps(rows, indent=1) + "\n").encode())
        self._file.chmod(0o600)


def _digest(secret: str) -> str:
    return hashlib.sha256(secret.encode()).hexdigest()
