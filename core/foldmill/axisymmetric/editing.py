"""Add and delete points of a strip: pure functions from parameters to parameters.

They serve any parameter model with ``points``, numbered 1, 2, 3 …. Points lie on the lines l1 and
l2 by turns, so that every later point changes its line together with its number. Whether a form
exists for the new points is for the family's ``generate`` to say.
"""

from __future__ import annotations

from typing import Any, TypeVar

from pydantic import ValidationError

from foldmill.design import Params
from foldmill.errors import InvalidParameters
from foldmill.numbered import inserted, moved, removed
from foldmill.refusals import explain

AnyParams = TypeVar("AnyParams", bound=Params)


def with_point(params: AnyParams, i: int, **values: Any) -> AnyParams:
    """Return parameters with another point as number i; later points move up by one.

    values : what the family states of a point, such as ``a=172.5, branch=-1``, ``y=30.0`` or
    ``r=97.3, z=-79.3``. One above the last number adds a point at the end. Raises InvalidParameters
    for a number that is not there, and for points that the family does not take.
    """
    return _changed(params, inserted(params.model_dump()["points"], i), {i: values})


def without_point(params: AnyParams, i: int) -> AnyParams:
    """Return parameters without point i; later points move down by one.

    Raises InvalidParameters as ``with_point`` does; a family says how few points it takes.
    """
    return _changed(params, removed(params.model_dump()["points"], i), {})


def _changed(params: AnyParams, numbers: dict[int, int], new: dict[int, Any]) -> AnyParams:
    model, values = type(params), params.model_dump()
    values["points"] = {**moved(values["points"], numbers), **new}
    try:
        return model.model_validate(model.renumbered(values, "points", numbers))
    except ValidationError as error:
        raise InvalidParameters(explain(error, model)) from None
