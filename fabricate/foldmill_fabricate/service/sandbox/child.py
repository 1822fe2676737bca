"""The life of one child of the nursery: limits, the function, its result, the end.

It finds ``arguments.json`` in its folder and leaves ``result.json`` there: ``{"value": …}``, or
``{"refused": sentence, "kind": name of the error}``. Files it makes lie beside them.
"""

from __future__ import annotations

import ctypes
import json
import os
import signal
import sys
import traceback
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

from foldmill.errors import FoldmillError
from foldmill.files import fence_process
from foldmill_fabricate import confining
from foldmill_fabricate.confining import Limits
from foldmill_fabricate.space import is_full, sentence

ARGUMENTS, RESULT, LOG = "arguments.json", "result.json", "log.txt"
_DIES_WITH_PARENT = 1  # PR_SET_PDEATHSIG of linux/prctl.h


def live(call: str, folder: Path, limits: Limits) -> NoReturn:
    """Run ``module:function`` in a folder and end this process; never returns."""
    code = 1
    try:
        confine(folder, limits)
        _write(folder, _outcome(call, folder, limits))
        code = 0
    except BaseException:
        traceback.print_exc()  # into the log of its folder
    finally:
        sys.stderr.flush()
        os._exit(code)


def confine(folder: Path, limits: Limits) -> None:
    """Take away from this process what its work may not use; what it prints goes to a file."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_DIES_WITH_PARENT, signal.SIGKILL)
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGCHLD):
        signal.signal(number, signal.SIG_DFL)
    os.chdir(folder)
    _silence(folder / LOG)
    fence_process(None)
    confining.confine(limits)


def _silence(log: Path) -> None:
    """Give this process no standard input, and a file to print to; the nursery's are its own."""
    nothing = os.open(os.devnull, os.O_RDONLY)
    file = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    for number, source in ((0, nothing), (1, file), (2, file)):
        os.dup2(source, number)
    os.closerange(3, 256)


def _outcome(call: str, folder: Path, limits: Limits) -> dict[str, Any]:
    """Return what becomes of the call, as result.json says it."""
    try:
        arguments = json.loads((folder / ARGUMENTS).read_bytes())
        with confining.refusing(limits, "The work"):
            return {"value": _function(call)(folder, **arguments)}
    except FoldmillError as error:
        told = str(error).replace(f"{folder}{os.sep}", "")  # where it lies is nobody's business
        return {"kind": type(error).__name__, "refused": told}
    except OSError as error:
        if is_full(error):
            return {"kind": "DiskFull", "refused": sentence(folder)}
        raise


def _function(call: str) -> Callable[..., Any]:
    module, _, name = call.partition(":")
    found: Callable[..., Any] = getattr(import_module(module), name)
    return found


def _write(folder: Path, outcome: dict[str, Any]) -> None:
    draft = folder / f".{RESULT}"
    draft.write_text(json.dumps(outcome, ensure_ascii=True, default=str))
    draft.replace(folder / RESULT)
