"""Vectors are multiplied as NumPy multiplies them, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill.vectors import cross, least, lengths, most, units


@pytest.mark.parametrize("shapes", [((3,), (3,)), ((7, 3), (7, 3)), ((5, 1, 3), (5, 4, 3))])
def test_a_cross_product_has_the_same_bits_as_numpys(shapes: tuple[tuple[int, ...], ...]) -> None:
    rng = np.random.default_rng(1)
    a, b = (rng.standard_normal(shape) for shape in shapes)
    assert (cross(a, b) == np.cross(a, b)).all()


def test_a_length_has_the_same_bits_as_numpys() -> None:
    vectors = np.random.default_rng(2).standard_normal((4, 50, 3))
    assert (lengths(vectors) == np.linalg.norm(vectors, axis=-1)).all()


def test_a_vector_without_length_has_no_direction() -> None:
    assert units(np.array([[0.0, 0.0], [3.0, -4.0]])).tolist() == [[0, 0], [0.6, -0.8]]


def test_the_least_and_the_greatest_of_three_are_numpys() -> None:
    triples = np.random.default_rng(3).standard_normal((4, 30, 3))
    assert (least(triples) == triples.min(axis=-1)).all()
    assert (most(triples) == triples.max(axis=-1)).all()
