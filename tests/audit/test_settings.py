"""Settings that have no meaning are refused; what changes no answer stays out of the report."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.audit import Settings
from satcheck.core.errors import SatcheckError


@pytest.mark.parametrize(
    "given",
    [
        {"clearance": -1.0},
        {"clearance": float("nan")},
        {"clearance": "5mm"},
        {"tolerance": float("inf")},
        {"accuracy": "best"},
        {"width": 0.0},
        {"budget": 0.0},
        {"budget": float("nan")},
        {"jobs": -1},
    ],
)
def test_refused(given):
    with pytest.raises(SatcheckError) as caught:
        Settings(**given)
    assert caught.value.code == "bad-setting"


def test_a_refusal_names_the_words_that_a_setting_takes():
    with pytest.raises(SatcheckError, match=r"accuracy: one of aabb, .*exact expected, not 'best'"):
        Settings(accuracy="best")
    with pytest.raises(SatcheckError, match=r"clearance: `float \| None` expected, not '2mm'"):
        Settings(clearance="2mm")  # type: ignore[arg-type]
    with pytest.raises(SatcheckError, match=r"clearance: `float` >= 0.0 expected, not -1"):
        Settings(clearance=-1)
    with pytest.raises(SatcheckError, match="planar: one of xy, yz, xz expected, not 'x'"):
        Settings(planar="x")


def test_settings_are_a_key_however_they_are_given():
    given = Settings(clearance=np.array(1.0), accept=["unread-file"])  # type: ignore[arg-type]
    assert {given} == {Settings(clearance=1.0, accept=("unread-file",))}


def test_what_changes_no_answer_is_not_in_the_report():
    stated = Settings().stated(depth=True, thickness=True)
    assert not {"jobs", "cache", "timings"} & set(stated.__struct_fields__)
    assert Settings(jobs=3, cache=False, timings=False).stated(depth=True, thickness=True) == stated
