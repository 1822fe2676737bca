"""When much of a program lies astray, look for the one cause that explains all of it.

Each suspect says where the strokes would have been drawn had that one mistake been made; the one
that explains nearly every point drawn, and every point to be drawn, is named.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill.tolerances import COINCIDENT_MM
from foldmill_fabricate.passes import Face, Fit, Plan, ProgramFile
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.planned import Planned
from foldmill_fabricate.verify.virtual_sheet import rotation, stored_offset, to_carrier

Floats = NDArray[np.float64]
Solver = Callable[[Floats, Floats], tuple[Floats, Floats]]


@dataclass(frozen=True)
class Cause:
    """One mistake that explains a program."""

    code: str
    message: str
    remedy: str

    def finding(self, where: str) -> Finding:
        """Return it as an error."""
        return Finding(self.code, Severity.ERROR, where, self.message, self.remedy)


def find_cause(
    plan: Plan,
    file: ProgramFile,
    drawn: Sequence[Floats],
    strokes: Sequence[Planned],
    fit: Fit | None,
    reach: float,
) -> Cause | None:
    """Return the one cause that explains a program, or None.

    drawn : polylines (n, 2) in carrier coordinates, mm; strokes : those of the whole plan;
    reach : how far a point may lie from where the cause puts it, mm.
    """
    own = [stroke for stroke in strokes if stroke.setup.number in file.setups]
    planned = [to_carrier(stroke.points, plan, file.face, fit) for stroke in own]
    if explained(planned, drawn, reach) >= tolerances.EXPLAINED:
        return None  # a few strokes are at fault, not the whole
    for cause, expected in _exact_suspects(plan, file, strokes, own, fit):
        if explained(expected, drawn, reach) >= tolerances.EXPLAINED:
            return cause
    return _distortion(plan, planned, drawn, reach)


def _exact_suspects(
    plan: Plan,
    file: ProgramFile,
    strokes: Sequence[Planned],
    own: Sequence[Planned],
    fit: Fit | None,
) -> Iterator[tuple[Cause, list[Floats]]]:
    for kind in ("none", "left-right", "end-over-end", "half-turn"):
        cause = _mirror_cause(plan, file.face, kind)
        if cause is not None:
            yield cause, [_turned(stroke.points, plan, kind, file.face) for stroke in own]
    if file.face is Face.REVERSE and fit is None and plan.machine.two_sides.is_known:
        yield _two_sides(), [to_carrier(s.points, plan, file.face, _AS_WISHED) for s in own]
    for cause, setups, face in _others(plan, file):
        other = [stroke for stroke in strokes if stroke.setup.number in setups]
        yield cause, [to_carrier(stroke.points, plan, face, fit) for stroke in other]
        if face is not file.face:
            yield cause, [to_carrier(stroke.points, plan, file.face, fit) for stroke in other]


def _others(plan: Plan, file: ProgramFile) -> Iterator[tuple[Cause, tuple[int, ...], Face]]:
    """Yield what else of the plan a program might draw: another pass, or another set-up."""
    for side in plan.passes:
        if side.face is not file.face:
            every = tuple(setup.number for setup in side.setups)
            yield _mistaken("wrong-face", f"the {side.face} pass"), every, side.face
        for setup in side.setups:
            if setup.number not in file.setups:
                early = setup.number > max(file.setups, default=0)
                code = "order" if early else "wrong-set-up"
                code = code if side.face is file.face else "wrong-face"
                turn = "later" if early else "earlier"
                label = f"set-up {setup.number} ({setup.name}), whose turn is {turn}"
                yield _mistaken(code, label), (setup.number,), side.face


def _mistaken(code: str, label: str) -> Cause:
    remedy = "Write the programs again; do not rename them."
    return Cause(code, f"It draws the strokes of {label}, not its own.", remedy)


def _mirror_cause(plan: Plan, face: Face, kind: str) -> Cause | None:
    planned = plan.flip.kind if face is Face.REVERSE else "none"
    if kind == planned:
        return None
    if kind == "none":
        message = f"The reverse is not mirrored; the sheet is turned over {planned}."
        return Cause("not-mirrored", message, "Mirror it about the plan's flip axis.")
    if planned == "none":
        message = f"The front is drawn as if the sheet had been turned over {kind}."
        return Cause("mirrored-front", message, "Write it as one looks at the front.")
    message = f"The reverse is drawn for a sheet turned {kind}, not {planned} as planned."
    return Cause("wrong-flip", message, "Write it for the flip that the plan names.")


_AS_WISHED = Fit(angle=0.0, dx=0.0, dy=0.0)


def _two_sides() -> Cause:
    message = "It is made for a flipped sheet that lies exactly where it ought to; the machine's "
    message += "stored offset of the two sides says otherwise."
    return Cause("two-sides", message, "Write the program for this machine again.")


def _turned(points: Floats, plan: Plan, kind: str, face: Face) -> Floats:
    """Carrier coordinates of sheet points after turning the blank, in its own middle, by a kind."""
    sheet = plan.sheet
    signs = {"none": (1, 1), "left-right": (-1, 1), "end-over-end": (1, -1), "half-turn": (-1, -1)}
    sign = np.array(signs[kind], float)
    size = np.array([sheet.width, sheet.height])
    lies = points * sign + np.where(sign < 0, size, 0.0)
    if face is Face.REVERSE:
        turn, shift = stored_offset(plan)
        lies = lies @ turn.T + shift
    carrier: Floats = lies + np.array([sheet.dx, sheet.dy])
    return carrier


def explained(expected: Sequence[Floats], drawn: Sequence[Floats], reach: float) -> float:
    """Return which share of the corners of either lies on the other."""
    if not expected or not drawn:
        return 0.0
    return min(_share_on(drawn, expected, reach), _share_on(expected, drawn, reach))


def _share_on(these: Sequence[Floats], those: Sequence[Floats], reach: float) -> float:
    """Return the share of corners of these lines that lie on those."""
    import shapely

    tree = shapely.STRtree([shapely.LineString(p) for p in those if len(p) > 1])
    points = shapely.points(np.vstack(these))
    hit = np.unique(tree.query(points, predicate="dwithin", distance=reach)[0])
    return len(hit) / len(points)


def _distortion(
    plan: Plan, expected: Sequence[Floats], drawn: Sequence[Floats], reach: float
) -> Cause | None:
    """Fit a displacement, then an affine map; name the first that explains the program."""
    if not expected or not drawn:
        return None
    goal, found = _corners(expected), _corners(drawn)
    for solve in (_rigid, _affine):
        turn, shift = _fitted(goal, found, solve)
        moved = [points @ turn.T + shift for points in expected]
        far = np.hypot(*(goal @ turn.T + shift - goal).T).max() > reach
        if far and explained(moved, drawn, reach) >= tolerances.EXPLAINED:
            middle = goal.mean(axis=0)
            return _named(plan, turn, middle, turn @ middle + shift)
    return None


def _corners(polylines: Sequence[Floats]) -> Floats:
    corners: Floats = np.unique(np.round(np.vstack(list(polylines)), 4), axis=0)
    return corners


def _fitted(goal: Floats, found: Floats, solve: Solver) -> tuple[Floats, Floats]:
    """Return A (2, 2) and b (2,) with found ≈ A·goal + b, from corners matched by nearness."""
    from scipy.spatial import cKDTree

    extent = np.ptp(goal, axis=0)
    free = (extent > 1) & (solve is _affine)
    scale = np.where(free, np.ptp(found, axis=0) / np.maximum(extent, 1), 1.0)
    middle = (goal.max(axis=0) + goal.min(axis=0)) / 2
    turn = np.diag(scale)
    shift = (found.max(axis=0) + found.min(axis=0)) / 2 - scale * middle
    tree = cKDTree(found)
    for _ in range(8):
        gaps, nearest = tree.query(goal @ turn.T + shift)
        good = gaps <= 3 * np.median(gaps) + COINCIDENT_MM
        turn, shift = solve(goal[good], found[nearest[good]])
    return turn, shift


def _rigid(goal: Floats, found: Floats) -> tuple[Floats, Floats]:
    middle, other = goal.mean(axis=0), found.mean(axis=0)
    (x, y), (u, v) = (goal - middle).T, (found - other).T
    angle = np.degrees(np.arctan2((x * v - y * u).sum(), (x * u + y * v).sum()))
    turn = rotation(float(angle))
    return turn, other - turn @ middle


def _affine(goal: Floats, found: Floats) -> tuple[Floats, Floats]:
    middle, other = goal.mean(axis=0), found.mean(axis=0)
    spread = goal - middle
    if len(goal) < 3 or np.linalg.svd(spread, compute_uv=False)[1] < 1.0:
        return np.eye(2), other - middle  # corners on one line say nothing across it
    turn = np.linalg.lstsq(spread, found - other, rcond=None)[0].T
    return turn, other - turn @ middle


def _named(plan: Plan, turn: Floats, middle: Floats, seen: Floats) -> Cause:
    """Say what an affine map does that moves ``middle`` to ``seen``."""
    x, y = (float(np.hypot(*turn[:, k])) for k in (0, 1))
    off = max(abs(x - 1), abs(y - 1))
    angle = float(np.degrees(np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])))
    if off <= tolerances.EVEN_SCALE:
        dx, dy = np.round(seen - rotation(angle) @ middle, 2) + 0.0  # no minus zero
        return Cause(
            "displaced",
            f"Everything lies shifted by ({dx:.2f}, {dy:.2f}) mm and turned by {angle:.3f}° about "
            f"the carrier's origin.",
            "If it was fitted to measured marks, verify it with the same marks.",
        )
    units = plan.machine.axes.units_per_mm
    if abs(x - y) <= tolerances.EVEN_SCALE:
        text = f"Everything is {_percent((x + y) / 2)}"
        units_text = f"{units * (x + y) / 2:.3f}"
    else:
        text = f"Everything is {_percent(x)} in x and {_percent(y)} in y"
        units_text = f"{units * x:.3f} in x and {units * y:.3f} in y"
    return Cause(
        "scale",
        f"{text}: the machine has {units:g} steps per mm, the program was made for {units_text}.",
        "Write the program with the machine's own steps per mm.",
    )


def _percent(scale: float) -> str:
    share = 100 * (scale - 1)
    return f"{abs(share):.2f} % too {'large' if share > 0 else 'small'}"
