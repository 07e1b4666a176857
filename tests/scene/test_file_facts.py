"""Units of several inputs: agreed on, a label; otherwise a warning."""

from __future__ import annotations

import pytest

from satcheck.scene.file_facts import common_units, units_differ


@pytest.mark.parametrize(
    ("declared", "labelled", "common"),
    [
        ({"a.obj": None, "b.obj": None}, False, None),
        ({"a.glb": "m", "b.glb": "meter"}, False, "m"),
        ({"a.glb": "m", "b.obj": None}, False, None),
        ({"a.glb": "parsec"}, False, None),
        ({"cell.toml": "mm", "b.obj": None}, True, "mm"),
        ({"cell.toml": "furlong"}, True, "furlong"),
        ({"cell.toml": "mm", "arm.urdf": "m"}, True, None),
    ],
)
def test_a_label_is_what_all_agree_on(declared, labelled, common):
    assert common_units(declared, labelled=labelled) == common


def test_different_units_are_a_warning_that_names_both():
    found = units_differ({"a.obj": None, "cell.toml": "mm", "arm.urdf": "metre"})
    assert found is not None
    assert (found.code, found.severity, found.file) == ("units-differ", "warning", "arm.urdf")
    assert "arm.urdf is in m, cell.toml in mm" in found.message


@pytest.mark.parametrize("other", ["m", "meter", "furlong", None])
def test_the_same_unit_by_two_names_or_an_unknown_one_is_none(other):
    assert units_differ({"arm.urdf": "m", "cell.toml": other}) is None
