"""What a command says: text for people, JSON for machines, an exit code for both."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Annotated, Any

import typer

from foldmill.finding import Finding, has_errors
from foldmill_fabricate.cli.layout import hanging, table

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")]


def say(as_json: bool, data: Any, text: str) -> None:
    """Print the data as JSON, or the text."""
    typer.echo(json.dumps(data, indent=2, ensure_ascii=False, default=str) if as_json else text)


def finding_lines(findings: Iterable[Finding]) -> str:
    """Return one line per finding, the worst first; the same finding in many places once."""
    rank = {"error": 0, "warning": 1, "info": 2}
    ordered = sorted(findings, key=lambda finding: rank[finding.severity])
    groups: dict[tuple[str, str], list[Finding]] = {}
    for finding in ordered:
        groups.setdefault((finding.severity, finding.code), []).append(finding)
    lines = []
    for (severity, _), found in groups.items():
        more = f" (and {len(found) - 1} more like it)" if len(found) > 1 else ""
        lines.append(hanging(f"{severity:8} {found[0]}{more}", " " * 9))
    return "\n".join(lines)


def finding_data(findings: Iterable[Finding]) -> list[dict[str, Any]]:
    """Return findings as plain data."""
    return [asdict(finding) for finding in findings]


def figure_lines(figures: Mapping[str, object]) -> str:
    """Return one line per figure."""
    return table([(name.replace("_", " "), _figure(value)) for name, value in figures.items()])


def _figure(value: object) -> str:
    """Return a figure as a person reads it; ``--json`` has all of its digits."""
    return f"{value:.6g}" if isinstance(value, float) else f"{value}"


def report_text(figures: Mapping[str, object]) -> str:
    """Return one line per figure, then a table for each figure that is a list of rows."""
    tables = {name: value for name, value in figures.items() if _is_rows(value)}
    parts = [figure_lines({k: v for k, v in figures.items() if k not in tables})]
    parts += [_row_table(rows) for rows in tables.values()]
    return "\n\n".join(part for part in parts if part)


def _is_rows(value: object) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(v, Mapping) for v in value)


def _row_table(rows: Any) -> str:
    heads = tuple(name.replace("_", " ") for name in rows[0])
    shown = [
        tuple(f"{v:.3g}" if isinstance(v, float) else f"{v}" for v in row.values()) for row in rows
    ]
    return table([heads, *shown])


def exit_code(findings: Iterable[Finding]) -> None:
    """Leave with 1 where there are errors among the findings."""
    if has_errors(list(findings)):
        raise typer.Exit(1)
