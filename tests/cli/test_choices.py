"""The choices of the command line are those of the library."""

from __future__ import annotations

from satcheck.audit.asked import settings
from satcheck.audit.asked.settings import Settings
from satcheck.cli import choices
from satcheck.core import conventions
from satcheck.scene import units


def test_the_same_values_can_be_chosen() -> None:
    assert choices.PLANES == conventions.PLANES
    assert choices.ACCURACIES == settings.ACCURACIES
    assert choices.FAIL_ON == settings.FAIL_ON
    assert tuple(units.MICROMETRES) == choices.UNITS
    assert choices.MOST_BUDGET == settings.MOST_BUDGET


def test_the_same_holds_where_nobody_says() -> None:
    default = Settings()
    assert default.accuracy == choices.ACCURACY
    assert default.fail_on == choices.LEAST_SEVERITY
    assert default.depth_width == choices.DEPTH_WIDTH
    assert default.depth_budget == choices.DEPTH_BUDGET
