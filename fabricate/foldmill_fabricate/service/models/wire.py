"""What all values on the wire have in common, and an error as one of them."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

DIGEST = "^[0-9a-f]{64}$"
Digest = Annotated[str, Field(pattern=DIGEST)]
"""A SHA-256 in hexadecimal."""
Slug = Annotated[str, Field(min_length=1, max_length=100)]
"""The name of a family, a material or a machine."""


class Wire(BaseModel):
    """Base of requests and responses: frozen, closed, documented by attribute docstrings."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, use_attribute_docstrings=True, allow_inf_nan=False
    )


def example(*bodies: dict[str, Any]) -> ConfigDict:
    """Return the configuration of a value that the description of the API shows so."""
    return ConfigDict(json_schema_extra={"examples": [*bodies]})


class Problem(Wire):
    """An error, as RFC 9457 has it, in ``application/problem+json``."""

    model_config = ConfigDict(extra="allow")

    type: str
    """A name for programs, such as urn:foldmill:cannot-plan."""
    title: str
    """What kind of error it is, in a few words."""
    status: int
    detail: str
    """One sentence for people: what, where, by how much, what to do."""
