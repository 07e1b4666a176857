"""The reference holds the lists of the registries and the settings."""

import pytest

from tests.plugin_marks import has

if not all(map(has, ("usd", "ifc", "step", "sdf", "mjcf", "tail"))):
    pytest.skip("the lists are of all formats, those of plug-ins too", allow_module_level=True)

from docs.names import LISTS, PAGE, filled


def test_the_reference_holds_the_lists_of_the_code() -> None:
    text = PAGE.read_text("utf-8")
    assert text == filled(text), "write them: python -m docs.names"


def test_each_list_stands_on_the_page() -> None:
    text = PAGE.read_text("utf-8")
    assert [name for name in LISTS if f"<!-- names: {name} -->" not in text] == []
