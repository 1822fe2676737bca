"""Forms that do not fold, and were wanted all the same: whatever file they go into says so."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from foldmill.design import Fold
from foldmill.exchange.keys import ERRORS
from foldmill.finding import Finding, Severity


def marked(fold: Fold, found: Iterable[Finding]) -> Fold:
    """Return the fold with the codes of its errors; as it is where there are none."""
    codes = sorted({finding.code for finding in found if finding.severity is Severity.ERROR})
    if not codes:
        return fold
    kept = dict(fold.meta.get("fold", {}))
    kept["frame"] = {**kept.get("frame", {}), ERRORS: codes}
    return replace(fold, meta={**fold.meta, "fold": kept})


def warning(fold: Fold) -> str:
    """Return the words for people on a fold that was marked; nothing for others."""
    codes = fold.meta.get("fold", {}).get("frame", {}).get(ERRORS, [])
    said = ", ".join(str(code) for code in codes) if isinstance(codes, list) else str(codes)
    return f"DOES NOT FOLD: {said}" if said else ""
