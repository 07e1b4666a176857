"""The lines of the items of a list, held against the syntax tree."""

from __future__ import annotations

import json
import random

import pytest

from satcheck.scene.format.item_lines import item_lines
from satcheck.scene.format.positions import Positions

TEXT = """ {
  "a": {"bodies": [
    0]}, "text": "\\"bodies\\": [",
  "bod\\u0069es" :
  [ {"id": "]"} ,
    [1,
     2], {},

    "\\n", -1.5e3, null], "b": [
  ]
}
"""


def shown_by_tree(text: str, count: int) -> list[int]:
    positions = Positions(text, toml=False)
    return [positions.line(("bodies", number)) for number in range(count)]


def test_lines_of_each_kind_of_value() -> None:
    assert list(item_lines(TEXT, "bodies")) == [5, 6, 7, 9, 9, 9] == shown_by_tree(TEXT, 6)
    assert list(item_lines(TEXT, "b")) == []


@pytest.mark.parametrize("indent", [None, 0, 3])
def test_lines_of_many_items(indent: int | None) -> None:
    chance = random.Random(3)
    bodies = [{"id": str(k), "at": [0.0] * chance.randrange(4)} for k in range(200)]
    text = json.dumps({"name": "x", "bodies": bodies, "units": "m"}, indent=indent)
    assert list(item_lines(text, "bodies")) == shown_by_tree(text, 200)


@pytest.mark.parametrize("text", ["", "[1]", '{"a": 1}', '{"bodies": [1'])
def test_what_is_no_such_document_is_refused(text: str) -> None:
    with pytest.raises((ValueError, IndexError)):
        list(item_lines(text, "bodies"))
