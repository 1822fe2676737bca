"""Chunks kept on disk, so that a sweep that was broken off goes on where it was.

A sweep has a folder of its own, named by the hash of all that decides its rows; a chunk is a file:
the SHA-256 of what follows, then arrays as NumPy keeps them.
"""

from __future__ import annotations

import json
import sys
from hashlib import sha256
from importlib.metadata import version
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from foldmill import Design
from foldmill_fabricate.explore.chunk import Chunk, Task, compute
from foldmill_fabricate.files import write_whole

FORM = 2
"""Of the files; another form is another sweep."""
DIGEST = sha256().digest_size


def key(task: Task) -> str:
    """Return the hash of a sweep: its family and its code, versions, parameters and ranges.

    A family made inside a function or a notebook has no code of its own to read.
    """
    stated = {
        "form": FORM,
        "foldmill": version("foldmill"),
        "numpy": np.__version__,
        "family": [task.design.slug, task.design.version, task.design.batch is not None],
        "code": [code_hash(name) for name in ("foldmill", *modules(task.design))],
        "base": task.base.model_dump(mode="json"),
        "vary": [[axis.name, axis.values.tolist()] for axis in task.grid.axes],
        "chunk_rows": task.chunk_rows,
    }
    return sha256(json.dumps(stated).encode()).hexdigest()


def modules(design: Design[Any]) -> tuple[str, ...]:
    """Return the top packages or modules that hold a family's code.

    What is made inside a function or a notebook is in none of them.
    """
    own = [each for each in (design.generate, design.params) if "<locals>" not in each.__qualname__]
    tops = {each.__module__.partition(".")[0] for each in own} - {"__main__"}
    return tuple(sorted(tops))


def code_hash(module: str) -> str:
    """Return the SHA-256 of a module's source, or of all Python files of a package; "" of none."""
    found = sys.modules[module]
    places = [Path(place) for place in getattr(found, "__path__", ())]
    files = [(file, place) for place in places for file in sorted(place.rglob("*.py"))]
    if not places and getattr(found, "__file__", None):
        file = Path(str(found.__file__))
        files = [(file, file.parent)]
    digest = sha256()
    for file, place in files:
        digest.update(f"{file.relative_to(place).as_posix()}\n".encode() + file.read_bytes())
    return digest.hexdigest() if files else ""


class Store:
    """The finished chunks of one sweep."""

    def __init__(self, folder: Path, task: Task) -> None:
        self.task = task
        self.folder = folder / f"{task.design.slug}-{key(task)[:16]}"

    def save(self, chunk: Chunk) -> None:
        """Keep a chunk."""
        out = BytesIO()
        told = json.dumps([[row, said] for row, said in chunk.faults.items()])
        figures = {f"figure {name}": column for name, column in chunk.figures.items()}
        arrays: dict[str, Any] = {
            "codes": chunk.codes,
            "at": chunk.at,
            "faults": np.array(told),
            **figures,
        }
        np.savez_compressed(out, **arrays)
        content = out.getvalue()
        write_whole(self._file(chunk.number), sha256(content).digest() + content)

    def __contains__(self, number: int) -> bool:
        return self._file(number).exists()

    def load(self, number: int) -> Chunk | None:
        """Return a chunk, or None where it is not there whole."""
        try:
            written = self._file(number).read_bytes()
        except OSError:
            return None
        seal, content = written[:DIGEST], written[DIGEST:]
        if sha256(content).digest() != seal:
            return None
        with np.load(BytesIO(content)) as kept:
            return _chunk(number, dict(kept))

    def _file(self, number: int) -> Path:
        return self.folder / f"{number:06d}.chunk"


def compute_and_keep(task: Task, store: Store, number: int) -> Chunk:
    """Compute a chunk and keep it where it was computed: it is not lost with whoever waits."""
    chunk = compute(task, number)
    store.save(chunk)
    return chunk


def _chunk(number: int, kept: dict[str, np.ndarray]) -> Chunk:
    faults = {int(row): str(said) for row, said in json.loads(str(kept["faults"]))}
    figures = {
        name.removeprefix("figure "): column
        for name, column in kept.items()
        if name.startswith("figure ")
    }
    return Chunk(number, kept["codes"], kept["at"], figures, faults)
