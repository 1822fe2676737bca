"""How large a request may be."""

from __future__ import annotations

from foldmill_fabricate.foreign import limits

MOST_JSON = 1 << 20
"""Bytes of a request."""
MOST_UPLOAD = 32 << 20
"""Bytes of an uploaded file."""
MOST_DRAWING = limits.BYTES
"""Bytes of an uploaded drawing in HP-GL."""
