"""The job sheet: what the operator needs on paper, two A4 pages.

Page 1 is for the machine (set-ups in order, the flip, the holes, a bar to check the print's scale),
page 2 for the hands (which crease folds by how much, in which order).
"""

from foldmill_fabricate.jobsheet.write import write

__all__ = ["write"]
