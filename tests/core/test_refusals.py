import pytest

from foldmill import InvalidParameters
from foldmill_plugins.rotational import DESIGN as BOWL
from foldmill_plugins.tuck import DESIGN as STOOL


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"n": 2}, "n must be at least 3, not 2."),
        ({"n": "x"}, "n must be a whole number, not 'x'."),
        ({"phi": 200.0}, "phi must be at most 180 deg, not 200."),
        ({"phi": float("nan")}, "phi must be a finite number, not NaN."),
        ({"points": {1: {"a": 40}, 2: {}}}, "points.2.a is missing: give it a value."),
        ({"nn": 4}, "There is no nn to set; there are n, phi, points"),
    ],
)
def test_a_wrong_value_is_told_with_its_limit_and_unit(
    values: dict[str, object], sentence: str
) -> None:
    with pytest.raises(InvalidParameters) as refusal:
        BOWL.validate(values)
    assert str(refusal.value).startswith(sentence)


def test_a_name_misspelt_inside_another_is_told_those_beside_it() -> None:
    with pytest.raises(InvalidParameters, match=r"no tucks\.0\.colour to set; there are .*side"):
        STOOL.validate({"tucks": [{"colour": 1}]})
