"""The service's side of the sandbox: orders to a nursery, and what became of each."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from collections import deque
from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from foldmill_fabricate.confining import Limits, TooMuch
from foldmill_fabricate.service.sandbox.refusals import Refused, SandboxFailed, TooBusy
from foldmill_fabricate.space import DiskFull, sentence

_ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MPLBACKEND": "agg"}
"""A library's own threads would not survive the fork of a child."""
_LEAST = 65_536
"""bytes without which a child cannot even say why it has failed."""
_ARGUMENTS, _RESULT, _LOG = "arguments.json", "result.json", "log.txt"


@dataclass
class _Work:
    """One piece of work, waiting or under way."""

    number: int
    call: str
    folder: Path
    limits: Limits
    what: str
    future: Future[Any] = field(default_factory=Future)


class Sandbox:
    """Processes that compute, so that the one that serves and streams does not.

    modules : imported in advance by the nursery; where one has a function ``warm``, it is called.
    at_once : pieces of work at the same time, by default one less than there are processors.
    waiting : how many more may wait. Folders of work are made within ``scratch``.
    """

    def __init__(
        self,
        scratch: Path,
        modules: Sequence[str] = (),
        at_once: int | None = None,
        waiting: int = 16,
    ) -> None:
        self.scratch, self._modules, self.waiting = scratch, tuple(modules), waiting
        self.at_once = at_once or max(1, (os.cpu_count() or 2) - 1)
        self._lock = threading.RLock()
        self._nursery: subprocess.Popen[bytes] | None = None
        self._ready = threading.Event()
        self._queue: deque[_Work] = deque()
        self._working: dict[int, _Work] = {}
        self._count = 0
        self._closed = False

    def start(self) -> None:
        """Start the nursery, where there is none; it imports while others go on."""
        with self._lock:
            if self._closed:
                raise TooBusy("The service is ending and takes no more work.")
            if self._nursery is None:
                self._nursery = self._started()

    def _started(self) -> subprocess.Popen[bytes]:
        self._ready = threading.Event()
        words = [sys.executable, "-m", "foldmill_fabricate.service.sandbox.nursery"]
        pipe = subprocess.PIPE
        made = subprocess.Popen(
            [*words, *self._modules],
            stdin=pipe,
            stdout=pipe,
            env={**os.environ, **_ONE_THREAD},
            start_new_session=True,  # Ctrl-C is for the service, which ends its nursery itself
        )
        threading.Thread(target=self._listen, args=(made,), daemon=True).start()
        return made

    def wait_ready(self, seconds: float = 60.0) -> bool:
        """Wait until the nursery has imported everything; tell whether it has."""
        self.start()
        return self._ready.wait(seconds)

    @property
    def load(self) -> tuple[int, int]:
        """Pieces of work under way, and waiting."""
        with self._lock:
            return len(self._working), len(self._queue)

    @property
    def pid(self) -> int | None:
        """The nursery's process, where there is one."""
        with self._lock:
            return self._nursery.pid if self._nursery else None

    def require_room(self) -> None:
        """Raise TooBusy where no more work may wait."""
        with self._lock:
            if len(self._queue) >= self.waiting:
                raise TooBusy(
                    f"{len(self._working)} pieces of work are under way and {len(self._queue)} "
                    "wait; there is no room for more. Try again in a minute."
                )

    def folder(self) -> Path:
        """Return a new folder to put files for a piece of work into."""
        self.scratch.mkdir(parents=True, exist_ok=True, mode=0o700)
        return Path(tempfile.mkdtemp(dir=self.scratch))

    def submit(
        self,
        call: str,
        arguments: Mapping[str, Any],
        *,
        folder: Path,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        what: str = "The work",
    ) -> Future[Any]:
        """Have ``module:function`` called as ``function(folder, **arguments)``.

        arguments : plain values. what : begins the sentence of a refusal, such as "The file". The
        future gives the plain value that was returned, or raises Refused, TooMuch or SandboxFailed;
        the folder stays, and is the caller's. Raises TooBusy where too much waits.
        """
        (folder / _ARGUMENTS).write_text(json.dumps(arguments))
        with self._lock:
            self.start()
            self.require_room()
            self._count += 1
            work = _Work(self._count, call, folder, limits, what)
            self._queue.append(work)
            self._begin()
        return work.future

    def run(self, call: str, arguments: Mapping[str, Any], **how: Any) -> Any:
        """Do as ``submit`` does and wait for the value; the folder is thrown away."""
        folder = self.folder()
        try:
            return self.submit(call, arguments, folder=folder, **how).result()
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def close(self) -> None:
        """End everything; what is under way or waits is refused."""
        with self._lock:
            self._closed = True
            nursery, self._nursery = self._nursery, None
            left = [*self._working.values(), *self._queue]
            self._working.clear()
            self._queue.clear()
        if nursery is not None:
            _end(nursery, was_ready=self._ready.is_set())
        for work in left:
            _settle(work, TooBusy("The service is ending; send it again when it is back."))

    def _begin(self) -> None:
        """Give the nursery as much as it may do at once; the lock is held."""
        while self._queue and len(self._working) < self.at_once:
            work = self._queue.popleft()
            if not work.future.set_running_or_notify_cancel():
                continue
            self._working[work.number] = work
            limits, folder = asdict(work.limits), str(work.folder.absolute())
            order = {"do": work.number, "call": work.call, "folder": folder, "limits": limits}
            self._order(order)

    def _order(self, order: Mapping[str, Any]) -> None:
        assert self._nursery is not None
        assert self._nursery.stdin is not None
        try:
            self._nursery.stdin.write(json.dumps(order).encode() + b"\n")
            self._nursery.stdin.flush()
        except OSError:
            return  # it has ended; whoever listens to it says so of all its work

    def _listen(self, nursery: subprocess.Popen[bytes]) -> None:
        """Take the reports of one nursery until it ends."""
        assert nursery.stdout is not None
        try:
            for line in nursery.stdout:
                said = json.loads(line)
                if "ready" in said:
                    self._ready.set()
                else:
                    self._ended(said)
        except (OSError, ValueError):
            pass  # its last line was cut short
        nursery.stdout.close()
        _end(nursery, was_ready=True)
        self._died(nursery)

    def _ended(self, said: Mapping[str, Any]) -> None:
        with self._lock:
            work = self._working.pop(said["ended"], None)
            if self._nursery is not None:
                self._begin()
        if work is not None:
            _settle(work, _outcome(work, said))

    def _died(self, nursery: subprocess.Popen[bytes]) -> None:
        """Refuse the work of a nursery that has ended by itself, and start another."""
        with self._lock:
            if self._nursery is not nursery:
                return
            self._nursery = None
            lost = [*self._working.values()]
            self._working.clear()
            if self._queue:
                self.start()
                self._begin()
        for work in lost:
            _settle(
                work,
                SandboxFailed(f"{work.what} was interrupted and nothing was kept. Try again."),
            )


def _end(nursery: subprocess.Popen[bytes], was_ready: bool) -> None:
    """End a nursery and its children: it does so itself when its input ends, unless it is stuck."""
    assert nursery.stdin is not None
    with suppress(OSError):
        nursery.stdin.close()
    try:
        nursery.wait(2.0 if was_ready else 0.0)
    except subprocess.TimeoutExpired:
        nursery.kill()
        nursery.wait()


def _outcome(work: _Work, said: Mapping[str, Any]) -> Any:
    """Return the value of work that has ended, or the error to raise."""
    if said["late"]:
        return work.limits.late(work.what)
    if said["signal"]:
        return work.limits.after(said["signal"], work.what) or SandboxFailed(
            f"{work.what} ended by itself (signal {said['signal']}) and nothing was kept. Try "
            "again; tell who runs this service if it happens twice."
        )
    try:
        result = json.loads((work.folder / _RESULT).read_bytes())
    except (OSError, ValueError):
        if shutil.disk_usage(work.folder.parent).free < _LEAST:
            return DiskFull(sentence(work.folder.parent))
        return SandboxFailed(
            f"{work.what} failed by a fault of foldmill's, and nothing was kept. Tell who runs "
            "this service; its log has more.",
            _log(work.folder),
        )
    if "refused" not in result:
        return result["value"]
    if result["kind"] == DiskFull.__name__:
        return DiskFull(result["refused"])
    if result["kind"] == "TooMuch":
        return TooMuch(result["refused"].replace("The work", work.what, 1))
    return Refused(result["refused"], result["kind"])


def _log(folder: Path) -> str:
    """Return what a child has printed, its end at most."""
    try:
        return (folder / _LOG).read_text(errors="replace")[-4000:]
    except OSError:
        return ""


def _settle(work: _Work, outcome: Any) -> None:
    if work.future.done():
        return
    if isinstance(outcome, Exception):
        work.future.set_exception(outcome)
    else:
        work.future.set_result(outcome)
