"""The results as a table: one line for each row of the grid. CSV and Parquet say the same.

Columns: ``row``, the varied parameters, ``outcome``, ``point`` (the one without candidate),
``region`` (0 where not free), then the figures; empty where there is none. Bytes depend on the
results alone.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.batch import NOWHERE
from foldmill_fabricate.errors import CannotExplore
from foldmill_fabricate.explore.sweep import WORDS, Sweep

SUFFIXES = (".csv", ".parquet")
LISTED = 100
"""Regions that a summary tells one by one; the table knows them all."""
_AT_ONCE = 50_000


def require_writable(file: Path) -> None:
    """Raise CannotExplore, before any work is done, where a table cannot be written so."""
    if file.suffix.lower() not in SUFFIXES:
        raise CannotExplore(f"{file}: a table is written as .csv or .parquet.")
    if file.suffix.lower() == ".parquet":
        try:
            import pyarrow.parquet  # noqa: F401
        except ImportError:
            raise CannotExplore(
                f'{file}: Parquet needs the extra "tables": pip install "foldmill[tables]". '
                "Or write .csv."
            ) from None


def table(sweep: Sweep[Any], file: Path) -> bytes:
    """Return the table in the form that the file's suffix names; raises CannotExplore."""
    require_writable(file)
    return parquet(sweep) if file.suffix.lower() == ".parquet" else csv(sweep)


def csv(sweep: Sweep[Any]) -> bytes:
    """Return the table as CSV, UTF-8 with a head line; numbers as short as they are exact."""
    columns = _columns(sweep, np.arange(0))
    out = BytesIO()
    out.write((",".join(_quoted(name) for name in columns) + "\n").encode())
    for first in range(0, len(sweep), _AT_ONCE):
        rows = np.arange(first, min(first + _AT_ONCE, len(sweep)))
        cells = [_cells(column) for column in _columns(sweep, rows).values()]
        out.write("".join(",".join(line) + "\n" for line in zip(*cells, strict=True)).encode())
    return out.getvalue()


def parquet(sweep: Sweep[Any]) -> bytes:
    """Return the table as Parquet; the shared parameters are in its metadata."""
    import pyarrow as pa
    from pyarrow import parquet as writer

    arrays = {}
    for name, column in _columns(sweep, np.arange(len(sweep))).items():
        array = pa.array(column, from_pandas=True)  # NaN is written as "no value"
        arrays[name] = array.dictionary_encode() if name == "outcome" else array
    stated = {
        "foldmill:design": json.dumps(_design(sweep)),
        "foldmill:faults": json.dumps({str(row): said for row, said in sweep.faults.items()}),
    }
    out = BytesIO()
    writer.write_table(pa.table(arrays).replace_schema_metadata(stated), out, compression="zstd")
    return out.getvalue()


def summary(sweep: Sweep[Any]) -> dict[str, Any]:
    """Return what was varied and what came of it, for machines: no times, no engine."""
    at = sweep.outcomes.at
    points, number = np.unique(at[at != NOWHERE], return_counts=True)
    return {
        "design": _design(sweep),
        "vary": [
            {
                "name": axis.name,
                "unit": axis.unit,
                "count": len(axis.values),
                "first": float(axis.values[0]),
                "last": float(axis.values[-1]),
                "goes_round": goes_round,
            }
            for axis, goes_round in zip(sweep.grid.axes, sweep.joined, strict=True)
        ],
        "rows": len(sweep),
        "counts": sweep.counts,
        "no_candidate_at": dict(zip(map(str, points.tolist()), number.tolist(), strict=True)),
        "free_regions": len(sweep.regions),
        "regions": list(_regions(sweep)),
        "faults": [
            {"row": row, "at": sweep.grid.told(row), "said": said}
            for row, said in list(sweep.faults.items())[:LISTED]
        ],
    }


def _regions(sweep: Sweep[Any]) -> Iterator[dict[str, Any]]:
    for region in sweep.regions[:LISTED]:
        yield {
            "number": region.number,
            "size": region.size,
            "ranges": {name: list(ends) for name, ends in region.ranges.items()},
            "centre_row": region.centre,
            "centre": sweep.grid.values(region.centre),
            "depth_steps": region.depth,
        }


def _design(sweep: Sweep[Any]) -> dict[str, Any]:
    return {
        "slug": sweep.design.slug,
        "version": sweep.design.version,
        "params": sweep.base.model_dump(mode="json"),
    }


def _columns(sweep: Sweep[Any], rows: NDArray[np.intp]) -> dict[str, NDArray[Any]]:
    found = sweep.outcomes
    words = np.full(max(WORDS) + 1, "", dtype=object)
    words[list(WORDS)] = list(WORDS.values())
    at = found.at[rows].astype(float)
    return {
        "row": rows,
        **sweep.grid.columns(rows),
        "outcome": words[found.codes[rows]],
        "point": np.where(at == NOWHERE, np.nan, at),
        "region": sweep.labels[rows],
        **{name: column[rows] for name, column in found.figures.items()},
    }


def _cells(column: NDArray[Any]) -> list[str]:
    if column.dtype == object:
        return [str(word) for word in column]
    if column.dtype.kind != "f":
        return [str(number) for number in column.tolist()]
    return ["" if number != number else _short(number) for number in column.tolist()]


def _short(number: float) -> str:
    return repr(number).removesuffix(".0")


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"' if set(name) & set(',"\n') else name
