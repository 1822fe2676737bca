"""Names of errors for programs: ``CannotPlan`` is ``urn:foldmill:cannot-plan``."""

from __future__ import annotations

import re


def dashed(kind: str) -> str:
    """Return the name of a class in small letters with dashes."""
    return re.sub(r"(?<!^)(?=[A-Z])", "-", kind).lower()


def urn(kind: str) -> str:
    """Return the ``type`` of a problem for the name of an error's class."""
    return f"urn:foldmill:{dashed(kind)}"
