"""Sweeps: many configurations of a family, what becomes of each, and where the free ones are.

from foldmill_fabricate.explore import Range, explore

tube = foldmill.installed().design("six-crease")
ranges = [Range.steps("phi", 20, 160, 5), Range.steps("beta", 0, 350, 10)]
sweep = explore(tube, tube.preset("vase"), ranges)
sweep.counts                    # rows by outcome
sweep.fold(sweep.regions[0].centre)
"""

from foldmill_fabricate.explore.chunk import FAULT
from foldmill_fabricate.explore.grid import AT_MOST, Axis, Grid
from foldmill_fabricate.explore.ranges import Range
from foldmill_fabricate.explore.regions import Region
from foldmill_fabricate.explore.sweep import WORDS, Sweep, explore
from foldmill_fabricate.explore.table import csv, parquet, summary, table
from foldmill_fabricate.explore.workers import Cluster, Engine, Local

__all__ = [
    "AT_MOST",
    "FAULT",
    "WORDS",
    "Axis",
    "Cluster",
    "Engine",
    "Grid",
    "Local",
    "Range",
    "Region",
    "Sweep",
    "csv",
    "explore",
    "parquet",
    "summary",
    "table",
]
