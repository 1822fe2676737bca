"""From parameters to a fold: solve the strip, fill its blanks, state the creases that close."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from foldmill import Fold, ImpossibleGeometry, InvalidParameters
from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.rosette import HalfWedge, Rosette, Seat
from foldmill.check.intersection import penetrations
from foldmill_plugins.tuck import blanks
from foldmill_plugins.tuck.blanks import Blank
from foldmill_plugins.tuck.params import Tuck, TuckParams

SAMPLES = 48
"""Places of t that the automatic tuck tries: 2 % of its range apart, finer than anyone folds."""


@dataclass(frozen=True, eq=False)
class _Flap:
    """A tuck in the making: its blank, its choice, and where its corner and facets are."""

    blank: Blank
    tuck: Tuck
    corner: int
    """Number of its corner among the half wedge's points."""
    faces: tuple[int, int]


def generate(params: TuckParams) -> Fold:
    """Return the fold; raises ImpossibleGeometry where a blank cannot be tucked."""
    solved = strip.solve(params.n, params.phi, dict(params.points))
    half, flaps = _add_flaps(HalfWedge.of(solved), blanks.find(solved), params.tucks)
    rose = rosette.assemble(half)
    for flap in flaps:
        t = _given(rose, flap) if flap.tuck.t is not None else _automatic(rose, flap)
        rose = _at(rose, flap, t)
    closed = {pair: sign for flap in flaps for pair, sign in _closed(rose, flap).items()}
    fold = rosette.fold(rose, closed, wedge_decides=not flaps)
    return replace(fold, meta={"tucks": [_report(rose, flap, closed) for flap in flaps]})


def _add_flaps(
    half: HalfWedge, found: list[Blank], tucks: tuple[Tuck, ...]
) -> tuple[HalfWedge, list[_Flap]]:
    chosen = {tuck.point: tuck for tuck in tucks}
    if len(chosen) < len(tucks):
        raise InvalidParameters("Two tucks name the same point; leave one of them out.")
    idle = sorted(set(chosen) - {blank.point for blank in found})
    if idle:
        raise InvalidParameters(
            f"There is no blank beside point {idle[0]}, so it needs no tuck: leave that tuck out, "
            f"or move the point off its line by giving it r and z."
        )
    faces: list[list[int]] = half.faces.tolist()
    flaps: list[_Flap] = []
    for blank in found:
        corner, (a, b) = len(half.flat) + len(flaps), blank.ends
        pair = [[a, blank.point, corner], [corner, blank.point, b]]
        faces += pair if blank.point % 2 == 0 else [triangle[::-1] for triangle in pair]
        tuck = chosen.get(blank.point, Tuck(point=blank.point))
        flaps.append(_Flap(blank, tuck, corner, (len(faces) - 2, len(faces) - 1)))
    middle = [blank.corner(float(np.mean(blank.reach())), 1) for blank in found]
    seats = tuple(Seat.L2 if blank.point % 2 == 0 else Seat.L1 for blank in found)
    return replace(
        half,
        flat=np.vstack([half.flat, *(spot for spot, _ in middle)]),
        spatial=np.vstack([half.spatial, *(spot for _, spot in middle)]),
        seats=half.seats + seats,
        faces=np.array(faces, np.intp),
    ), flaps


def _at(rose: Rosette, flap: _Flap, t: float) -> Rosette:
    """Return the form with the flap's corner at t."""
    flat, spatial = rose.half.flat.copy(), rose.half.spatial.copy()
    flat[flap.corner], spatial[flap.corner] = flap.blank.corner(t, flap.tuck.side)
    return rose.moved(replace(rose.half, flat=flat, spatial=spatial))


def _is_free(rose: Rosette, flap: _Flap) -> bool:
    """Tell whether the flap of one wedge passes through nothing; its copies follow by symmetry."""
    among = rose.wedge_faces(np.array(flap.faces))
    return not len(penetrations(rose.spatial, rose.edges, rose.faces, among))


def _free_run(rose: Rosette, flap: _Flap) -> tuple[float, float] | None:
    """Return the longest run of t in which the flap passes through nothing."""
    low, high = flap.blank.reach()
    step = (high - low) / SAMPLES
    runs: list[list[float]] = [[]]
    for k in range(SAMPLES):
        t = low + (k + 0.5) * step
        if _is_free(_at(rose, flap, t), flap):
            runs[-1].append(t)
        elif runs[-1]:
            runs.append([])
    longest = max(runs, key=len)
    return (longest[0], longest[-1]) if longest else None


def _automatic(rose: Rosette, flap: _Flap) -> float:
    run = _free_run(rose, flap)
    if run is None:
        low, high = flap.blank.reach()
        raise ImpossibleGeometry(
            f"The tuck beside point {flap.blank.point} penetrates the form wherever its corner "
            f"lies between t = {low:.6g} and {high:.6g} mm. Move point {flap.blank.point}."
        )
    return sum(run) / 2


def _given(rose: Rosette, flap: _Flap) -> float:
    t = float(flap.tuck.t or 0.0)
    if not _is_free(_at(rose, flap, t), flap):
        run = _free_run(rose, flap)
        hint = (
            f"between {run[0]:.6g} and {run[1]:.6g} mm it is free"
            if run
            else f"no other t is free either, so move point {flap.blank.point}"
        )
        raise ImpossibleGeometry(
            f"The tuck beside point {flap.blank.point} penetrates the form at t = {t:g} mm; {hint}."
        )
    return t


def _closed(rose: Rosette, flap: _Flap) -> dict[tuple[int, int], int]:
    """Return the sign of the creases A-t and t-B, which fold to ±180, seen from above.

    Along the seam A-P_i three creases meet in one line: two of ``turning``, one of ±180. Together
    they must turn by what the surface turns there without the tuck, which is within ±180.
    """
    a, b = flap.blank.ends
    signs = []
    for end in (a, b):
        pair = sorted((end, flap.blank.point))
        turning = rose.fold_angles[(rose.edge_origins == pair).all(axis=1)]
        signs.append(-int(np.sign(turning.sum())))
    # Where both ends agree the tuck lies on one side of the surface; else nobody can tell.
    sign = signs[0] if signs[0] == signs[1] else 0
    return {(a, flap.corner): sign, (b, flap.corner): sign}


def _report(rose: Rosette, flap: _Flap, closed: dict[tuple[int, int], int]) -> dict[str, object]:
    sign = closed[flap.blank.ends[0], flap.corner] * (-1 if rosette.is_inside_out(rose) else 1)
    t = float(rose.half.flat[flap.corner] @ flap.blank.along)
    side = {1: "inside", -1: "outside", 0: "undetermined"}[sign]
    return {"point": flap.blank.point, "t": round(t, 6), "lies": side}
