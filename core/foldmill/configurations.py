"""What becomes of configurations of a design: by its own batch, or one by one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

import numpy as np

from foldmill.batch import NOWHERE, Column, Outcome, Outcomes, breaches
from foldmill.check import check, penetration
from foldmill.design import Design, Fold, Params, Symmetry
from foldmill.errors import (
    BrokenBatch,
    InvalidInput,
    InvalidParameters,
    NoCandidate,
    PluginFault,
    one_line,
)
from foldmill.folded import FoldedForm
from foldmill.tolerances import COINCIDENT_MM

P = TypeVar("P", bound=Params)


def outcomes(design: Design[P], base: P, columns: Mapping[str, Column]) -> Outcomes:
    """Return what becomes of a design when some of its parameters take the values of columns.

    base : the parameters that all rows share; columns : (n,) each, by dotted name.
    Raises InvalidParameters for columns of unequal length or of no parameter, BrokenBatch where the
    design's own batch breaks its contract, PluginFault.
    """
    lengths = {name: len(column) for name, column in columns.items()}
    if len(set(lengths.values())) > 1:
        raise InvalidParameters(f"The columns must be equally long, but they are {lengths}.")
    if design.batch is not None:
        return _of_batch(design, base, {name: _lent(each) for name, each in columns.items()})
    return one_by_one(design, base, columns)


def _lent(column: Column) -> Column:
    """Return a column that cannot be written into."""
    lent = column.view()
    lent.flags.writeable = False
    return lent


def _of_batch(design: Design[P], base: P, columns: Mapping[str, Column]) -> Outcomes:
    assert design.batch is not None
    try:
        found = design.batch(base, columns)
    except InvalidParameters:
        raise
    except InvalidInput as error:
        raise _broken(design, f"it fails with {one_line(error).rstrip('.')}") from error
    rows = len(next(iter(columns.values()), ()))
    for said in breaches(found, rows, {*columns, *type(base).model_fields}):
        raise _broken(design, said)
    return found


def _broken(design: Design[Any], said: str) -> BrokenBatch:
    return BrokenBatch(
        f"The batch of the family {design.slug!r} is broken: {said}. Tell its author; "
        "replace(design, batch=None) does without it."
    )


def one_by_one(design: Design[P], base: P, columns: Mapping[str, Column]) -> Outcomes:
    """Return the same by generating and checking each row; raises what ``outcomes`` raises."""
    count = len(next(iter(columns.values()), ()))
    codes, at = np.zeros(count, np.uint8), np.full(count, NOWHERE, np.int32)
    rows: list[Mapping[str, float]] = []
    for row in range(count):
        values = {name: column[row] for name, column in columns.items()}
        codes[row], at[row], measured = _outcome(design, base, values)
        rows.append(measured)
    names = sorted({name for measured in rows for name in measured})
    figures = {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}
    return Outcomes(codes, at, figures, alone=count)


def with_values(design: Design[P], base: P, values: Mapping[str, float]) -> P:
    """Return a base model with some values replaced, by dotted name.

    A whole number stays one where its field is a count. Raises InvalidParameters.
    """
    nested = base.model_dump(mode="json")
    for name, value in values.items():
        _set(nested, name, value)
    return design.validate(nested)


def require_known(base: Params, names: Iterable[str]) -> None:
    """Raise InvalidParameters, with the names there are, for a dotted name of no parameter."""
    for name in names:
        _set(base.model_dump(mode="json"), name, 0.0)


def _set(nested: Any, name: str, value: float) -> None:
    *path, last = name.split(".")
    for part in path:
        nested = nested[_key(nested, part, name)]
    place = _key(nested, last, name)
    was = nested[place]
    if isinstance(was, bool):
        nested[place] = bool(value)
    elif isinstance(was, int) and float(value).is_integer():
        nested[place] = int(value)
    else:
        nested[place] = float(value)


def _key(nested: Any, part: str, name: str) -> Any:
    keys = list(nested) if isinstance(nested, dict) else []
    keys = list(range(len(nested))) if isinstance(nested, list) else keys
    for key in keys:
        if str(key) == part:
            return key
    known = ", ".join(str(key) for key in keys) or "nothing"
    raise InvalidParameters(f"There is no parameter {name!r}: {part!r} is not among {known}.")


def _outcome(
    design: Design[P], base: P, values: Mapping[str, float]
) -> tuple[Outcome, int, Mapping[str, float]]:
    try:
        params = with_values(design, base, values)
    except InvalidParameters:
        if any(_is_unknown(base, name) for name in values):
            raise
        return Outcome.REFUSED, NOWHERE, {}
    try:
        fold = design.run(params)
    except NoCandidate as refusal:
        return Outcome.NO_CANDIDATE, refusal.point, {}
    except InvalidInput:
        return Outcome.REFUSED, NOWHERE, {}
    return outcome_of(fold), NOWHERE, figures_of(fold)


def _is_unknown(base: Params, name: str) -> bool:
    try:
        _set(base.model_dump(mode="json"), name, 0.0)
    except InvalidParameters:
        return True
    return False


def outcome_of(fold: Fold) -> Outcome:
    """Return what the checks make of a fold; raises PluginFault where it has no folded form."""
    if fold.folded is None:
        raise PluginFault("A configuration has no folded form, so nothing can be said of it.")
    if penetration(fold).has_errors:
        crosses = fold.symmetry is not None and _crosses_axis(fold.symmetry, fold)
        return Outcome.CROSSES_AXIS if crosses else Outcome.PENETRATES
    return Outcome.REFUSED if check(fold).has_errors else Outcome.FREE


def _crosses_axis(symmetry: Symmetry, fold: Fold) -> bool:
    """Tell whether the half wedge has vertices on both sides of the axis."""
    assert fold.folded is not None
    middle = np.pi / (2 * symmetry.order)
    wedge = np.unique(fold.pattern.faces[symmetry.wedge])
    along = fold.folded.vertices[wedge, :2] @ (np.cos(middle), np.sin(middle))
    return bool(along.min() < -COINCIDENT_MM and along.max() > COINCIDENT_MM)


def figures_of(fold: Fold) -> dict[str, float]:
    """Return height and widths of the folded form and of the sheet, mm."""
    sheet = np.ptp(fold.pattern.vertices, axis=0)
    form = _box(fold.folded) if fold.folded is not None else {}
    return {**form, "sheet_x_mm": float(sheet[0]), "sheet_y_mm": float(sheet[1])}


def _box(folded: FoldedForm) -> dict[str, float]:
    x, y, z = np.ptp(folded.vertices, axis=0)
    return {"height_mm": float(z), "width_x_mm": float(x), "width_y_mm": float(y)}
