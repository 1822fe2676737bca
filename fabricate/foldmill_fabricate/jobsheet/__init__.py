"""The job sheet: what the operator and the folder need on paper, pages of A4.

Page 1 is for the machine (set-ups in order, the flip, the holes, a bar to check the print's scale),
the others for the hands: which crease goes which way and how far, then the form and in which order.
"""

from foldmill_fabricate.jobsheet.write import write

__all__ = ["write"]
