"""The stool as a job: a service, a queue, and a person who answers at every gate."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from foldmill_fabricate.errors import CannotSend

if TYPE_CHECKING:
    from foldmill_fabricate.client import Client
    from foldmill_fabricate.jobs import Question

Say = Callable[[str], None]
_PATIENCE = 120.0
"""s in which something has to happen."""


def make_job(folder: Path, port: str, say: Say) -> None:
    """Submit a job folder to a service of its own, and answer what the job asks.

    port : of a simulated plotter. Raises CannotSend where the job does not end as it should.
    """
    say("\n5. The same sheet as a job: `foldmill serve` has the plotter, and asks a person")
    try:
        from foldmill_fabricate.client import Client as _  # noqa: F401
        from foldmill_fabricate.jobs.host import Host as _Host  # noqa: F401
    except ImportError:
        say("   left out: install foldmill[service] for it")
        return
    with tempfile.TemporaryDirectory(prefix="foldmill-") as state, _service(state, port) as client:
        from foldmill_fabricate.jobs import Submission

        asked = Submission(plan=client.keep(folder), plotter="bench")
        job = client.submit(asked, "the demo").id
        say(f"   job {job} submitted over {client.url}")
        _attend(client, job, say)
        lines = client.history(job)
        say(f"   {len(lines)} lines of history: who, when and what; the wire is kept, too")


@contextmanager
def _service(state: str, port: str) -> Iterator[Client]:
    """Run a service in a process of its own while the context lasts; yields its client."""
    from foldmill_fabricate.client import Client
    from foldmill_fabricate.jobs import Places
    from foldmill_fabricate.service.reach import reached

    words = ["serve", "--port", "0", "--state", state, "--plotter", f"bench={port}"]
    with subprocess.Popen(
        [sys.executable, "-m", "foldmill_fabricate", *words],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "FOLDMILL_DATABASE": ""},
    ) as service:
        try:
            end = time.monotonic() + _PATIENCE
            while (url := reached(Places(Path(state), ""))) is None:
                if service.poll() is not None or time.monotonic() > end:
                    raise CannotSend("The demo's service did not start; try `foldmill serve`.")
                time.sleep(0.1)
            with Client(url) as client:
                yield client
        finally:
            service.terminate()


def _attend(client: Client, job: str, say: Say) -> None:
    """Be the person: do what is asked, and say so."""
    from foldmill_fabricate.jobs import JobState

    end = time.monotonic() + _PATIENCE
    while not (record := client.job(job)).is_ended:
        for question in client.questions(job):
            _answer(client, question, say)
            end = time.monotonic() + _PATIENCE
        if time.monotonic() > end:
            raise CannotSend(f"The demo's job {job} does not go on: it is {record.state.value}.")
        time.sleep(0.1)
    if record.state is not JobState.DONE:
        raise CannotSend(f"The demo's job {job} is {record.state.value}. {record.note}")
    say(f"   job {job} is done: sheet {', '.join(record.sheets)}")


def _answer(client: Client, question: Question, say: Say) -> None:
    from foldmill_fabricate.jobs import Kind, Reply

    wanted = question.kind is not Kind.TRY  # nothing is learnt of a material that is not there
    where = f" before {question.setup}" if question.setup else ""
    client.answer(question.id, Reply(ok=wanted, sheet=question.sheet), "the demo")
    say(f"   asked to {question.kind.value}{where}: {'done' if wanted else 'not needed here'}")
