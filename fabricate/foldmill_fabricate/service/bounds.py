"""How large a request may be."""

from __future__ import annotations

MOST_JSON = 1 << 20
"""Bytes of a request."""
MOST_UPLOAD = 32 << 20
"""Bytes of an uploaded file."""
