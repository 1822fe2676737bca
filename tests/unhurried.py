"""For a sandbox whose work is judged: its processes run at the priority of who runs the tests.

What computes beside machines gives way to everything else. Ten thousand pieces of work that do so,
on a computer that does other things, would take a day.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

from foldmill_fabricate import shelf
from foldmill_fabricate.foreign import Asked, make_folder


def warm() -> None:
    """Take the priority of the tests, where that is allowed, and load what plans drawings."""
    with TemporaryDirectory() as place:
        asked = Asked(pen=("1=cut",), material="pp-0.75", machine="generic-hpgl-600")
        of, on = shelf.material(asked.material), shelf.machine(asked.machine)
        make_folder(b"SP1;PD;PU400,400;CI400;", asked, of, on, Path(place) / "job")
    with suppress(PermissionError):
        os.setpriority(os.PRIO_PROCESS, 0, os.getpriority(os.PRIO_PROCESS, os.getppid()))


def of_tests() -> str:
    """Return PYTHONPATH with the folder of the tests, for a nursery to find this module."""
    known = os.environ.get("PYTHONPATH", "")
    return os.pathsep.join([str(Path(__file__).parent), *filter(None, [known])])
