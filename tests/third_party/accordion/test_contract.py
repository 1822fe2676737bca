import pytest
from foldmill_accordion import DESIGN

from foldmill.testing import design_checks


@pytest.mark.parametrize("check", design_checks(DESIGN), ids=str)
def test_contract(check):
    check()
