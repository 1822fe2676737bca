"""The contract every design keeps. Run it from your own test suite::

    @pytest.mark.parametrize("check", design_checks(DESIGN), ids=str)
    def test_contract(check):
        check()

A check raises AssertionError with a sentence that says what is wrong and where.
"""

from __future__ import annotations

import json
import re
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from foldmill import agreement
from foldmill.check import RULES, Report, check, penetration, symmetry
from foldmill.check.intersection import penetrations
from foldmill.corners import corners, numbers
from foldmill.design import Design, Fold, Params
from foldmill.errors import FoldmillError, InvalidParameters, PluginFault, one_line
from foldmill.exchange.fold import read, write
from foldmill.finding import Severity
from foldmill.pattern import Assignment
from foldmill.schema import Bound, Leaf, leaves, models, objects, outside, placed

_DOTTED = re.compile(r"[\w-]+(?:\.[\w-]+)*")
_KEBAB = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
_NOTHING: Mapping[str, str] = {}


@dataclass(frozen=True)
class Check:
    """One rule of the contract, for one design: a name, and a call that raises AssertionError."""

    name: str
    run: Callable[[], None]

    def __call__(self) -> None:
        """Run it; raises AssertionError, whatever goes wrong."""
        try:
            self.run()
        except AssertionError:
            raise
        except Exception as error:
            raise AssertionError(f"{self.name} cannot be run. {one_line(error)}") from error

    def __str__(self) -> str:
        return self.name


def design_checks(
    design: Design[Any], expected_failures: Mapping[str, str] = _NOTHING
) -> list[Check]:
    """Return every check for one design: its schema, its bounds, its defaults and each preset.

    expected_failures : check name → reason, for what is known to fail. Such a check passes as long
    as it fails, and fails once it passes. Raises ValueError for a name that is no check's.
    """
    checks = [Check(name, partial(rule, design)) for name, rule in _RULES.items()]
    for case in ["defaults", *design.presets]:
        for name, each in (_CASE_RULES | (_BATCH_RULES if design.batch else {})).items():
            checks.append(Check(f"{name}[{case}]", partial(each, design, case)))
    unknown = sorted(set(expected_failures) - {check.name for check in checks})
    if unknown:
        known = ", ".join(check.name for check in checks)
        raise ValueError(f"There is no check {unknown[0]!r}. There are: {known}.")
    return [_expected(check, expected_failures.get(check.name)) for check in checks]


def _expected(check: Check, reason: str | None) -> Check:
    return check if reason is None else Check(check.name, partial(_must_fail, check, reason))


def _must_fail(check: Check, reason: str) -> None:
    try:
        check()
    except Exception:  # whatever way it fails, it does what was said
        return
    raise AssertionError(
        f"{check.name} passes, though it is said to fail: {reason}. Do not say so."
    )


def _require(holds: object, sentence: str) -> None:
    if not holds:
        raise AssertionError(sentence)


def _params(design: Design[Any], case: str) -> Params:
    params: Params = design.params() if case == "defaults" else design.presets[case]
    return params


def _slug(design: Design[Any]) -> None:
    for word in (design.slug, *design.presets):
        _require(_KEBAB.fullmatch(word), f"The name {word!r} must be lowercase words and hyphens.")
    _require(design.title.strip(), f"The design {design.slug} needs a title.")


def _documented(design: Design[Any]) -> None:
    schema = design.schema()
    json.dumps(schema, allow_nan=False)
    for name, part in objects(schema):
        for field, prop in part.get("properties", {}).items():
            place = f"{name}.{field}".lstrip(".")
            _require(prop.get("description"), f"{place}: document it with an attribute docstring.")


def _closed(design: Design[Any]) -> None:
    for name, part in objects(design.schema()):
        if "properties" in part:
            place = name or "the parameters"
            said = f"{place}: derive it from Params, so that it refuses what is unknown."
            _require(part.get("additionalProperties") is False, said)


def _defaults(design: Design[Any]) -> None:
    for name, field in design.params.model_fields.items():
        _require(not field.is_required(), f"{name}: give it a default, so that the design runs.")


def _units(design: Design[Any]) -> None:
    for leaf in leaves(design.schema()):
        if leaf.is_number and not leaf.is_integer:
            said = f"{leaf.name}: use Length, Coordinate or Angle, or bound a ratio by 0 and 1."
            _require(leaf.unit or leaf.is_ratio, said)


def _unknown_refused(design: Design[Any]) -> None:
    values = {"no-such-parameter": 1}
    _refused(design, values, "no-such-parameter", "a parameter that does not exist")


def _bounds_kept(design: Design[Any]) -> None:
    for values, leaf, bound in _out_of_bounds(design):
        number = f"{outside(bound, leaf.is_integer)!r}, beyond its bound {bound.value:g},"
        _refused(design, values, leaf.name, f"{leaf.name} = {number}")


def _bounds_hold(design: Design[Any]) -> None:
    """Of two bounds of one sort, a quantity's and a field's, pydantic keeps the quantity's."""
    for model in models(design.params):
        for name, field in model.model_fields.items():
            for sort, tightest in (("ge", max), ("gt", max), ("le", min), ("lt", min)):
                stated = [getattr(each, sort, None) for each in field.metadata]
                values = [value for value in stated if value is not None]
                said = (
                    f"{model.__name__}.{name}: {sort}={values} contradict, and only the last holds."
                )
                _require(not values or values[-1] == tightest(values), said)


def _out_of_bounds(design: Design[Any]) -> Iterator[tuple[dict[str, Any], Leaf, Bound]]:
    for whole, leaf in numbers(design):
        for bound in leaf.bounds:
            yield placed(whole, leaf.path, outside(bound, leaf.is_integer)), leaf, bound


def _nan_refused(design: Design[Any]) -> None:
    for whole, leaf in numbers(design):
        values = placed(whole, leaf.path, float("nan"))
        _refused(design, values, leaf.name, f"{leaf.name} = NaN")


def _refused(design: Design[Any], values: dict[str, Any], name: str, what: str) -> None:
    try:
        design.validate(values)
    except InvalidParameters as error:
        _require(_names(str(error), name), f"{what} is refused without its name.")
    else:
        raise AssertionError(f"{what} is accepted; it must be refused.")


def _names(sentence: str, name: str) -> bool:
    """Tell whether a word of the sentence is the dotted name; it may say more on the way."""
    said = [iter(word.split(".")) for word in _DOTTED.findall(sentence)]
    return any(all(part in parts for part in name.split(".")) for parts in said)


def _presets(design: Design[Any]) -> None:
    for name, preset in design.presets.items():
        _require(isinstance(preset, design.params), f"{name}: a preset is a {design.params}.")
        again = design.validate(preset.model_dump(mode="json"))
        _require(again == preset, f"{name}: its values as JSON give other parameters.")


def _returns_a_fold(design: Design[Any], case: str) -> None:
    made = design.generate(_params(design, case))
    _require(isinstance(made, Fold), f"generate returns {type(made).__name__}, not a Fold.")


def _params_untouched(design: Design[Any], case: str) -> None:
    params = _params(design, case)
    before = params.model_dump_json()
    design.run(params)
    _require(params.model_dump_json() == before, "generate changes the parameters it is given.")


def _deterministic(design: Design[Any], case: str) -> None:
    one, two = (write(design.run(_params(design, case))) for _ in range(2))
    _require(one == two, "The same parameters give two different patterns.")


def _without_errors(design: Design[Any], case: str) -> None:
    _require_no_errors(check(design.run(_params(design, case))), "")


def _require_no_errors(report: Report, where: str) -> None:
    errors = [str(finding) for finding in report.findings if finding.severity is Severity.ERROR]
    _require(not errors, where + " ".join(errors))


def _assigned(design: Design[Any], case: str) -> None:
    pattern = design.run(_params(design, case)).pattern
    count = pattern.count(Assignment.U)
    said = f"{count} creases are neither mountain, valley nor flat; the family must say which."
    _require(not count, said)


def _symmetric(design: Design[Any], case: str) -> None:
    """What is said of the symmetry is true, and the half wedge gives the verdict of the whole."""
    fold = design.run(_params(design, case))
    if fold.symmetry is None or fold.folded is None:
        return
    solid, pattern = fold.folded.vertices, fold.pattern
    untrue = symmetry.fault(fold.symmetry, solid, pattern.faces)
    _require(not untrue, f"The symmetry it states is not there: {untrue}.")
    if fold.symmetry.one_sided:
        decides = symmetry.half_wedge_decides(fold.symmetry, solid, pattern.faces)
        _require(decides, "It is said to be one-sided, but its half wedge crosses the axis.")
        wedge = penetrations(solid, pattern.edges, pattern.faces[fold.symmetry.wedge])
        whole = penetrations(solid, pattern.edges, pattern.faces)
        said = f"The half wedge has {len(wedge)} penetrations, the whole form {len(whole)}."
        _require(bool(len(wedge)) == bool(len(whole)), said)


def _corners_answered(design: Design[Any]) -> None:
    """At the ends of its parameters a design gives a sheet that folds, or refuses in a sentence."""
    for what, values in corners(design):
        try:
            params = design.validate(values)
            before = params.model_dump_json()
            with warnings.catch_warnings():
                warnings.simplefilter("error", RuntimeWarning)
                fold = design.run(params)
        except PluginFault as error:
            raise AssertionError(f"At {what}: {error}") from error
        except FoldmillError:
            continue
        unchanged = params.model_dump_json() == before
        _require(unchanged, f"At {what}: generate changes the parameters it is given.")
        _require_no_errors(Report.joined(rule(fold) for rule in _STRUCTURE), f"At {what}: ")


def _round_trip(design: Design[Any], case: str) -> None:
    written = write(design.run(_params(design, case)))
    _require(write(read(written)) == written, "Its FOLD file changes when it is read and written.")


def _batch_agrees(design: Design[Any], case: str) -> None:
    agreement.require(design, _params(design, case), case)


_STRUCTURE = tuple(rule for rule in RULES if rule is not penetration)
"""A form may pass through itself at the ends of its parameters; it may not fall to pieces."""
_RULES: dict[str, Callable[[Design[Any]], None]] = {
    "slug": _slug,
    "documented": _documented,
    "closed": _closed,
    "defaults": _defaults,
    "units": _units,
    "presets": _presets,
    "unknown-refused": _unknown_refused,
    "bounds-hold": _bounds_hold,
    "bounds-kept": _bounds_kept,
    "nan-refused": _nan_refused,
    "corners-answered": _corners_answered,
}
_CASE_RULES: dict[str, Callable[[Design[Any], str], None]] = {
    "returns-a-fold": _returns_a_fold,
    "params-untouched": _params_untouched,
    "deterministic": _deterministic,
    "without-errors": _without_errors,
    "assigned": _assigned,
    "symmetric": _symmetric,
    "fold-round-trip": _round_trip,
}
_BATCH_RULES = {"batch-agrees": _batch_agrees}
