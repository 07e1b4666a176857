"""The pages hold the lists of names that the readers ask."""

from pathlib import Path

import pytest

from tests.plugin_marks import has

if not all(map(has, ("usd", "ifc", "step", "sdf", "mjcf"))):
    pytest.skip("the lists are of all formats, those of plug-ins too", allow_module_level=True)

from docs.names import LISTS, PAGES, filled


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_a_page_holds_the_lists_of_the_code(page: Path) -> None:
    text = page.read_text("utf-8")
    assert text == filled(text), "write them: python -m docs.names"


def test_each_list_stands_on_a_page() -> None:
    text = "".join(page.read_text("utf-8") for page in PAGES)
    assert [name for name in LISTS if f"<!-- names: {name} -->" not in text] == []
