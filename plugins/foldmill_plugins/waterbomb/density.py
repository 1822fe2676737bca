"""How many bases, and how many of them along u: from what is wanted of the form or of the sheet.

A few aspects of the cells are tried. As d falls with the square root of the bases and so do facets,
each form made says about how many it would need; in the end grids beside the best one are tried.
Every number told comes from a form made, and fewest means: of all that were tried.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from foldmill_plugins.waterbomb.build import Build
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.trial import Trial, tried

ASPECTS = (1.0, 1.4, 2.0, 0.7, 0.5)
"""Bases along u against those of square cells, for as many along v."""
PILOT = 80
"""Bases of the first trials: enough that d falls as it does later."""
GROWTH = 1.5
"""By how much more bases are tried where a grid is not sound."""
HOPELESS = 1.5
"""Share of the best's bases beyond which an aspect is given up."""
REACH = 2
"""Strips more and less than the best's, looked at in the end."""
STEPS = 12
"""Grids along one aspect, at most."""


@dataclass(eq=False)
class Search:
    """The grids tried so far, and what is wanted of them."""

    params: WaterbombParams
    made: dict[tuple[int, int], Trial] = field(default_factory=dict)

    @property
    def is_for_distance(self) -> bool:
        """Whether few bases are wanted, for a distance; else many, for a sheet."""
        return self.params.wanted.distance is not None

    @property
    def step(self) -> int:
        """By how many strips grids differ: a form that closes along v needs an even number."""
        return 2 if self.params.surface.surface().is_v_periodic else 1

    def at(self, n_u: int, n_v: int) -> Trial:
        """Return the trial of a grid, made once."""
        if (n_u, n_v) not in self.made:
            self.made[n_u, n_v] = tried(self.params, n_u, n_v)
        return self.made[n_u, n_v]

    def does(self, trial: Trial) -> bool:
        """Tell whether a trial is sound and gives what is wanted."""
        wanted = self.params.wanted
        close = wanted.distance is None or trial.distance <= wanted.distance
        large = wanted.smallest is None or trial.smallest >= wanted.smallest
        return trial.is_sound and close and large and trial.bases <= wanted.most_bases

    def needed(self, trial: Trial) -> float:
        """Return about how many bases of a trial's aspect give what is wanted."""
        wanted = self.params.wanted
        if wanted.distance is not None:
            return trial.bases * (trial.distance / wanted.distance) ** 2
        return trial.bases * (trial.smallest / (wanted.smallest or 1.0)) ** 2

    def better(self, one: Trial | None, two: Trial) -> bool:
        """Tell whether two has fewer bases than one, or more where many are wanted."""
        if one is None:
            return True
        if self.is_for_distance:
            return (two.bases, two.distance) < (one.bases, one.distance)
        return (-two.bases, two.distance) < (-one.bases, one.distance)

    @property
    def best(self) -> Trial | None:
        """The best trial that does, or None."""
        found: Trial | None = None
        for trial in self.made.values():
            if self.does(trial) and self.better(found, trial):
                found = trial
        return found


def report(params: WaterbombParams) -> dict[str, Any]:
    """Report n_u and n_v for what is wanted: a distance, or a smallest facet on a sheet."""
    wanted = params.wanted
    if wanted.distance is None and wanted.smallest is None:
        return {"advice": "State wanted.distance, or wanted.smallest and wanted.sheet_width."}
    search = Search(params)
    best = chosen(search)
    if best is None:
        nearest = min(search.made.values(), key=lambda each: (not each.is_sound, each.distance))
        return {
            "n_u": None,
            "n_v": None,
            "looked_at": len(search.made),
            "advice": f"Nothing with {wanted.most_bases} bases or fewer does. The closest form "
            f"found has {nearest.n_u} × {nearest.n_v} bases, d = {nearest.distance:.3g} and a "
            f"smallest facet of {nearest.smallest:.3g}.",
        }
    return {
        "n_u": best.n_u,
        "n_v": best.n_v,
        "bases": best.bases,
        "distance": best.distance,
        "smallest_mm" if wanted.sheet_width is not None else "smallest_units": best.smallest,
        "looked_at": len(search.made),
        "advice": f"--n-u {best.n_u} --n-v {best.n_v}",
    }


def chosen(search: Search) -> Trial | None:
    """Return the best grid that was found, or None."""
    square = _square(search.params)
    for aspect in ASPECTS:
        _follow(search, square * aspect)
    _look_about(search)
    return search.best


def _square(params: WaterbombParams) -> float:
    """Return n_u / n_v of cells that are as wide as they are high in the mean."""
    surface = Build(params).surface
    share = (np.arange(20) + 0.5) / 20
    u, v = (low + share * (high - low) for low, high in (surface.u, surface.v))
    jet = surface.jet(np.repeat(u, 20), np.tile(v, 20))
    wide, high = (float(np.linalg.norm(each, axis=1).mean()) for each in (jet.u, jet.v))
    return wide * float(np.ptp(surface.u)) / (high * float(np.ptp(surface.v)))


def _grid(search: Search, ratio: float, bases: float) -> tuple[int, int]:
    """Return n_u and n_v whose ratio and product are about these."""
    step = search.step
    n_v = max(step, step * round(np.sqrt(max(bases, 1.0) / ratio) / step))
    return max(3, round(bases / n_v)), n_v


def _follow(search: Search, ratio: float) -> None:
    """Try grids of one aspect: from what each would need to the next, then between the nearest.

    Ends early where the aspect needs many more bases than the best so far, or gives many fewer.
    """
    bases, few, many = float(PILOT), 0.0, np.inf
    for _ in range(STEPS):
        grid = _grid(search, ratio, bases)
        is_new = grid not in search.made
        trial = search.at(*grid)
        if not is_new or _is_hopeless(search, trial):
            return
        if search.does(trial) == search.is_for_distance:
            many = min(many, trial.bases)
        else:
            few = max(few, trial.bases)
        bases = float(search.needed(trial)) if trial.is_sound else GROWTH * trial.bases
        if not few < bases < many:
            bases = np.sqrt(max(few, 4.0) * many) if np.isfinite(many) else GROWTH * few
        if bases > search.params.wanted.most_bases:
            return


def _is_hopeless(search: Search, trial: Trial) -> bool:
    best = search.best
    if best is None or not trial.is_sound:
        return best is not None and search.is_for_distance and trial.bases > HOPELESS * best.bases
    ratio = search.needed(trial) / best.bases
    return ratio > HOPELESS if search.is_for_distance else ratio < 1 / HOPELESS


def _look_about(search: Search) -> None:
    """Try grids with more and fewer strips than the best one's, better ones only."""
    best, rounds = search.best, 0
    while best is not None and rounds < STEPS:
        rounds += 1
        for strips in range(-REACH, REACH + 1):
            n_v = best.n_v + strips * search.step
            if n_v >= search.step:
                _along(search, n_v)
        if search.best is best:
            return
        best = search.best


def _along(search: Search, n_v: int) -> None:
    """Try ever better grids of n_v strips, as long as they do."""
    for _ in range(STEPS):
        best = search.best
        if best is None:
            return
        n_u = (best.bases - 1) // n_v if search.is_for_distance else best.bases // n_v + 1
        if n_u < 3 or (n_u, n_v) in search.made:
            return
        trial = search.at(n_u, n_v)
        if not search.does(trial):
            return
        jump = round(search.needed(trial) / n_v)
        if (jump < n_u) == search.is_for_distance and jump >= 3 and jump != n_u:
            search.at(jump, n_v)
