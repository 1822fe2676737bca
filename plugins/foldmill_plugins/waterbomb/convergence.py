"""How the search went, step by step: the two graphs of Fig. 6.6."""

from __future__ import annotations

from typing import Any

from foldmill_plugins.waterbomb.depths import settled
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.solve import Developed


def report(params: WaterbombParams) -> dict[str, Any]:
    """Report the angle sums and their errors at the base mesh and after every step."""
    return steps(settled(params).developed)


def steps(found: Developed) -> dict[str, Any]:
    """Return the columns of the graphs: α in deg, and e = |360 − α| (Eq. 6.2), step by step."""
    greatest, smallest, mean = (list(column) for column in zip(*found.extremes, strict=True))
    return {
        "iterations": found.iterations,
        "is_converged": found.is_converged,
        "alpha_max_deg": greatest,
        "alpha_min_deg": smallest,
        "alpha_ave_deg": mean,
        "e_max_deg": [abs(360 - each) for each in greatest],
        "e_min_deg": [abs(360 - each) for each in smallest],
        "e_ave_deg": [abs(360 - each) for each in mean],
        "e_total_deg": list(found.errors),
    }
