"""The sheet with the places of what planning found, as a picture: ``places.png``."""

from __future__ import annotations

from collections.abc import Mapping

from foldmill import Fold
from foldmill_fabricate.passes import Plan


def write(plan: Plan, fold: Fold) -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return ``places.png``."""
    from foldmill_fabricate.pictures import places_picture

    return {"places.png": places_picture(plan)}
