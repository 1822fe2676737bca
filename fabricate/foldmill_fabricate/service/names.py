"""Names of the files that the service and its sandbox give each other in a folder of work."""

from __future__ import annotations

from foldmill_fabricate.names import PATTERN as PATTERN

UPLOAD = "upload"
"""What was sent, as it came."""
JOB = "job"
"""A job folder."""
AS_CUT = "as-cut.svg"
