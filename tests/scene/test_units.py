"""Which declarations name a unit."""

from __future__ import annotations

import pytest

from satcheck.cli.lengths import MICROMETRES
from satcheck.scene.units import is_unit


@pytest.mark.parametrize("text", ["mm", "Metres", " inches ", "m (assumed)", "mm(file)", "feet"])
def test_known(text):
    assert is_unit(text)


@pytest.mark.parametrize("text", ["furlong", "(mm)", "millimters", "s", " "])
def test_unknown(text):
    assert not is_unit(text)


def test_every_unit_of_the_command_line_can_be_declared():
    assert all(map(is_unit, MICROMETRES))
