"""What all values of a plan have in common."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict

XY = tuple[float, float]
"""mm"""


class Value(BaseModel):
    """Read only; nothing in it but what is named, and no number that is none."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


def without(written: dict[str, Any], **usual: object) -> dict[str, Any]:
    """Leave out what is as it is for a sheet that holds one part."""
    return {
        name: value
        for name, value in written.items()
        if name not in usual or value not in (usual[name], ())
    }
