"""Every exception is a FoldmillError and the builtin it means."""

from __future__ import annotations

import pytest

from foldmill import errors


@pytest.mark.parametrize(
    ("error", "builtin"),
    [
        (errors.InvalidInput, ValueError),
        (errors.InvalidPattern, ValueError),
        (errors.InvalidParameters, ValueError),
        (errors.ImpossibleGeometry, ValueError),
        (errors.NoCandidate, ValueError),
        (errors.UnreadableFile, ValueError),
        (errors.UnknownName, LookupError),
        (errors.PluginFault, TypeError),
        (errors.BrokenBatch, TypeError),
    ],
)
def test_both_habits_catch_it(error: type[Exception], builtin: type[Exception]) -> None:
    assert issubclass(error, errors.FoldmillError)
    assert issubclass(error, builtin)


def test_the_tree_in_the_docstring_names_every_exception() -> None:
    classes = [
        name
        for name, value in vars(errors).items()
        if isinstance(value, type) and issubclass(value, errors.FoldmillError)
    ]
    assert len(classes) == 10
    assert [name for name in classes if name not in (errors.__doc__ or "")] == []


def test_an_unknown_name_comes_with_the_known_ones() -> None:
    assert str(errors.UnknownName.of("family", "tuk", ["tuck", "rotational"])) == (
        "There is no family 'tuk'. There are: rotational, tuck."
    )
    assert str(errors.UnknownName.of("port", "x", [])).endswith("There are: none.")


def test_among_many_names_the_nearest_is_named() -> None:
    known = [f"roll-{width}" for width in range(600, 1300, 100)]
    assert str(errors.UnknownName.of("machine", "rol-900", known)).endswith(
        "Did you mean 'roll-900'?"
    )
    assert str(errors.UnknownName.of("machine", "laser", known)).endswith("roll-900.")
