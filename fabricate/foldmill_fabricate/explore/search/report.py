"""The files of a search: each form as FOLD, a table, and one picture of them all."""

from __future__ import annotations

import csv
import json
from io import StringIO
from typing import Any

from foldmill.exchange import fold as fold_file
from foldmill_fabricate.explore.search.picture import picture
from foldmill_fabricate.explore.search.request import Request
from foldmill_fabricate.explore.search.results import Result
from foldmill_fabricate.explore.search.run import Outcome
from foldmill_fabricate.explore.search.targets import Target

TABLE, LISTING, PICTURE = "results.csv", "results.json", "results.png"
DECIMALS = 4
"""Of what is measured, mm."""


def contents(outcome: Outcome, request: Request, family: str) -> dict[str, bytes]:
    """Return the files by name, the listing last; the same results give the same bytes."""
    results = outcome.results
    files = {fold_name(k): fold_file.write(r.fold).encode() for k, r in enumerate(results, 1)}
    files[TABLE] = _table(results, request).encode()
    if results:
        files[PICTURE] = picture(results, request)
    listing = json.dumps(data(outcome, request, family), indent=1, ensure_ascii=False)
    return {**files, LISTING: f"{listing}\n".encode()}


def fold_name(rank: int) -> str:
    """Return the name of the file of one result."""
    return f"{rank}.fold"


def data(outcome: Outcome, request: Request, family: str) -> dict[str, Any]:
    """Return all of it as plain data: what was asked, what was done, what was found."""
    sheet = request.sheet
    return {
        "family": family,
        "targets": [vars(target) for target in request.targets],
        "sheet_mm": [sheet.width, sheet.height],
        "clearance_mm": sheet.clearance,
        "least_crease_mm": request.least_crease,
        "fixed": dict(request.fixed),
        "vary": list(request.vary),
        "seed": request.seed,
        "evaluations": outcome.evaluations,
        "stopped_early": outcome.stopped,
        "results": [_row(rank, each) for rank, each in enumerate(outcome.results, 1)],
    }


def _row(rank: int, result: Result) -> dict[str, Any]:
    return {
        "rank": rank,
        "start": result.start,
        "meets_targets": not result.missed,
        "error": round(result.error, 8),
        "missed": [missed(target, result) for target in result.missed],
        "figures_mm": {name: round(value, DECIMALS) for name, value in result.figures.items()},
        "params": result.params,
    }


def missed(target: Target, result: Result) -> str:
    """Return in words by how much a result misses a target."""
    by = target.miss(result.figures)
    most = f"{target.tolerance:g} mm allowed"
    return f"{target.name} is {abs(by):.2f} mm too {'large' if by > 0 else 'small'} ({most})"


def _table(results: list[Result], request: Request) -> str:
    names = [target.name for target in request.targets]
    figures = names + [
        name for name in (results[0].figures if results else ()) if name not in names
    ]
    out = StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["rank", "start", "meets_targets", "error", *(f"{name}_mm" for name in figures)])
    for rank, each in enumerate(results, 1):
        measured = [round(each.figures[name], DECIMALS) for name in figures]
        rows.writerow([rank, each.start, not each.missed, round(each.error, 8), *measured])
    return out.getvalue()
