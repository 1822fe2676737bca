"""The search for a shape: parameters of any family that meet targets, by the checks' leave.

Nothing here knows a family. What varies are the numbers in its schema; where it starts are its
presets and random variants of them; what decides is what the folded form and the sheet measure.
"""

from foldmill_fabricate.explore.search.report import contents
from foldmill_fabricate.explore.search.request import Request
from foldmill_fabricate.explore.search.results import Result
from foldmill_fabricate.explore.search.run import Outcome, search
from foldmill_fabricate.explore.search.targets import Target

__all__ = ["Outcome", "Request", "Result", "Target", "contents", "search"]
