"""A design: a parameter model and a pure function from parameters to a fold.

Parameters are declared once, with unit, bounds and an attribute docstring; options, forms, schema,
validation and documentation follow from that one place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Annotated, Any, Generic, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from foldmill.batch import Column, Outcomes
from foldmill.errors import (
    FoldmillError,
    InvalidParameters,
    InvalidPattern,
    PluginFault,
    UnknownName,
    one_line,
)
from foldmill.finding import Finding
from foldmill.folded import FoldedForm
from foldmill.handle import Handle
from foldmill.motion import Motion
from foldmill.pattern import CreasePattern, Indices
from foldmill.refusals import explain
from foldmill.stage import Stage

MOST_MM = 1e5
"""mm. Nothing in a pattern lies farther out: 100 m of paper, far below where squares overflow."""
Length = Annotated[
    float, Field(gt=0, lt=MOST_MM, allow_inf_nan=False, json_schema_extra={"x-unit": "mm"})
]
"""A length in mm, positive and below 100 m. A field's own ``ge`` and ``le`` hold as well; its
``gt`` and ``lt`` would not."""
Coordinate = Annotated[
    float, Field(gt=-MOST_MM, lt=MOST_MM, allow_inf_nan=False, json_schema_extra={"x-unit": "mm"})
]
"""A signed position in mm, within 100 m. A field's own ``ge`` and ``le`` hold as well; its ``gt``
and ``lt`` would not."""
Angle = Annotated[float, Field(allow_inf_nan=False, json_schema_extra={"x-unit": "deg"})]
"""An angle in degrees, finite."""
Count = Annotated[int, Field(strict=True, gt=0)]
"""A whole number, 1 or more. A field's own ``ge`` and ``le`` hold as well; its ``gt`` would not."""

_NOTHING: Mapping[str, Any] = MappingProxyType({})


class Params(BaseModel):
    """Base of all parameter models: frozen, closed, documented by attribute docstrings."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, use_attribute_docstrings=True, validate_default=True
    )

    @classmethod
    def renumbered(
        cls,
        values: dict[str, Any],
        name: str,  # noqa: ARG003 - for models that override it
        moved: Mapping[int, int],  # noqa: ARG003
    ) -> dict[str, Any]:
        """Return plain values after numbered parts were inserted or dropped: as they are.

        name : the parameter with the parts, such as "points"; moved : old number → new number of
        every part that is still there. A model overrides it where other parameters name such parts.
        """
        return values


@dataclass(frozen=True, eq=False)
class Symmetry:
    """The rotational symmetry of a fold about the z axis, as the intersection check may use it."""

    order: int
    """N: the form maps to itself when turned by 360/N degrees."""
    wedge: Indices
    """(k,) faces of one half wedge; mirrored and turned they make the whole form."""
    one_sided: bool
    """True where every signed radius has one sign, so that no facet crosses the axis. Only then do
    the half wedge's own facets decide whether the whole form is free of penetration. The half wedge
    lies between the azimuths 0 and 180/N degrees, or opposite; checked before it is believed."""


@dataclass(frozen=True, eq=False)
class Fold:
    """A pattern, its folded form where one is known, and what is known beside them."""

    pattern: CreasePattern
    folded: FoldedForm | None = None
    symmetry: Symmetry | None = None
    motions: Mapping[str, Motion] = field(default_factory=dict)
    """Ways the form moves, by name."""
    handles: tuple[Handle, ...] = ()
    """Points that a person can drag."""
    meta: Mapping[str, Any] = field(default_factory=dict)
    """Facts for people and files: ``design`` (slug, version, params), ``designed`` (what its family
    says of the result: name → number, text or truth value, which travels with the file and is told
    by ``check``), ``title``, foreign keys; ``read`` where it comes from a file."""
    findings: tuple[Finding, ...] = ()
    """What only the family can know is wrong with it, or how its file was mended; ``check`` tells
    it with its own."""

    def __post_init__(self) -> None:
        if self.folded is not None and len(self.folded.vertices) != len(self.pattern.vertices):
            raise InvalidPattern(
                f"The pattern has {len(self.pattern.vertices)} vertices, "
                f"its folded form {len(self.folded.vertices)}."
            )


P = TypeVar("P", bound=Params)


@dataclass(frozen=True)
class Design(Generic[P]):
    """What a plugin offers. ``presets`` feed gallery, command line and golden tests alike."""

    slug: str
    title: str
    params: type[P]
    generate: Callable[[P], Fold]
    presets: Mapping[str, P] = field(default_factory=dict)
    references: tuple[str, ...] = ()
    version: str = "1"
    reports: Mapping[str, Callable[[P], Mapping[str, Any]]] = field(default_factory=dict)
    """Longer analyses, made when asked for: name → function from parameters to named figures."""
    batch: Callable[[P, Mapping[str, Column]], Outcomes] | None = None
    """Many configurations at once: (base, columns by dotted name) → outcomes, row by row. Where a
    design has none, its rows are generated and checked one by one. Raises InvalidParameters where
    it does not know a column; a row out of bounds is REFUSED, never raised."""
    stages: Callable[[P], tuple[Stage, ...]] | None = None
    """The shapes on the way to the form, in order, for pictures: parameters → stages."""

    def schema(self) -> dict[str, Any]:
        """Return the JSON schema of the parameters, ``x-unit`` beside every physical quantity."""
        return self.params.model_json_schema()

    def preset(self, name: str) -> P:
        """Return the parameters of a preset; raises UnknownName with the names there are."""
        if name not in self.presets:
            raise UnknownName.of(f"preset of {self.slug}", name, self.presets)
        return self.presets[name]

    def validate(self, values: Mapping[str, Any]) -> P:
        """Turn raw values (a form, a file, a command line) into parameters.

        Raises InvalidParameters with one sentence for each value that is out of bounds, PluginFault
        where the family itself is at fault.
        """
        with _blamed(self.slug):
            try:
                return self.params.model_validate(values)
            except ValidationError as error:
                raise InvalidParameters(explain(error, self.params)) from None

    def run(self, values: Mapping[str, Any] | P = _NOTHING) -> Fold:
        """Validate, generate, and record in ``meta`` which design and parameters it was.

        Raises what ``validate`` raises, ImpossibleGeometry, and PluginFault where the family fails
        in a way that no user can mend.
        """
        require_sound(self)
        params = values if isinstance(values, self.params) else self.validate(dict(values))
        with _blamed(self.slug):
            fold = self.generate(params)
            if not isinstance(fold, Fold):
                raise PluginFault(
                    f"The family {self.slug!r} is broken: its generate returns "
                    f"{type(fold).__name__}, not a Fold."
                )
            stated = params.model_dump(mode="json")
            record = {"slug": self.slug, "version": self.version, "params": stated}
            meta = {"title": self.title, **fold.meta, "design": record}
            return replace(fold, meta=meta)

    def report(self, name: str, params: P) -> Mapping[str, Any]:
        """Return one of the family's reports; raises UnknownName, PluginFault."""
        if name not in self.reports:
            raise UnknownName.of(f"report of {self.slug}", name, self.reports)
        with _blamed(self.slug):
            return self.reports[name](params)


def require_sound(design: Design[Any]) -> None:
    """Raise PluginFault, naming the family, where a design is not made of what it must be."""
    is_model = isinstance(design.params, type) and issubclass(design.params, Params)
    for holds, said in (
        (isinstance(design.slug, str), f"its slug is {design.slug!r}, which is no text"),
        (isinstance(design.title, str), f"its title is {design.title!r}, which is no text"),
        (is_model, f"its params are {design.params!r}, which is no kind of Params"),
        (callable(design.generate), f"its generate is {design.generate!r}, which is no function"),
        (isinstance(design.presets, Mapping), "its presets are no mapping from names to Params"),
    ):
        if not holds:
            raise PluginFault(f"The family {design.slug!r} is broken: {said}.")


@contextmanager
def _blamed(slug: str) -> Iterator[None]:
    """Turn whatever a family raises by mistake into a sentence that names the family."""
    try:
        yield
    except FoldmillError:
        raise
    except (Exception, SystemExit) as error:
        raise PluginFault(
            f"The family {slug!r} is broken: with these parameters it fails with "
            f"{one_line(error).rstrip('.')}. Other parameters may work; tell its author."
        ) from error
