"""Names of the files in a job folder."""

from __future__ import annotations

PLAN = "plan.json"
"""Written last, so that a folder with a plan is complete."""
PATTERN = "pattern.fold"
"""What the plan was made from, where it was made from a pattern."""
JOB_SHEET = "job-sheet.pdf"
