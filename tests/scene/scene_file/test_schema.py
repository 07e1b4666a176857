"""The published schema and the reader refuse the same documents."""

from __future__ import annotations

import random
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from satcheck.scene.scene_file.schema import schema
from tests.scene.scene_file.scenes import BOX, errors, full
from tests.scene.scene_file.test_scene_1 import WRONG

SCHEMA = schema()
VALIDATOR = Draft202012Validator(SCHEMA)

# What no schema of one value can say; the schema's description names them.
BEYOND = {
    *("same id", "missing", "no mesh", "outside", "nobody", "half of them", "moved twice"),
    *("static moves", "times", "long turn", "crossing"),
}
# Put in the place of any value of a right document, each is wrong in most places.
STRANGERS: list[Any] = [
    *(None, True, "x", "", -1, 0, 1.5, "2mm", [], {}, [0, 0, 0], [1, 2], [1, 2, 3], [1, 2, 3, 4]),
    *(BOX, {"type": "cone", "radius": 1, "height": 2}, ["a"], [""], [[1, 2, 3]], {"x": 1}),
]


def test_a_scene_with_everything_follows_it() -> None:
    VALIDATOR.validate(full())


def test_an_outline_is_a_shape() -> None:
    points = [[0, 0], [1.5, 0], [0, 1]]
    body = {"id": "a", "shape": {"type": "outline", "points": points}}
    VALIDATOR.validate({"schema": "satcheck.scene/1", "bodies": [body]})


@pytest.mark.parametrize("name", sorted(WRONG.keys() - BEYOND))
def test_it_refuses_what_the_reader_refuses(name: str) -> None:
    document = full()
    WRONG[name][0](document)
    assert not VALIDATOR.is_valid(document)


def places(value: Any, keys: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The way to every value within."""
    inner = value.items() if isinstance(value, dict) else enumerate(value)
    found = []
    for key, one in inner:
        found.append((*keys, key))
        if isinstance(one, dict | list):
            found += places(one, (*keys, key))
    return found


def at(document: Any, keys: tuple[Any, ...]) -> Any:
    for key in keys:
        document = document[key]
    return document


def mutants(seed: int, count: int) -> list[tuple[str, dict[str, Any]]]:
    """Right documents with one change: a value replaced, a key left out, misspelt or added."""
    chance = random.Random(seed)
    found = []
    for _ in range(count):
        document = full()
        keys = chance.choice(places(document))
        owner, key = at(document, keys[:-1]), keys[-1]
        kind = chance.choice(["replace", "replace", "replace", "remove", "misspell", "add"])
        if kind == "replace":
            owner[key] = chance.choice(STRANGERS)
        elif kind == "remove":
            del owner[key]
        elif kind == "misspell" and isinstance(owner, dict):
            owner[key + "s"] = owner.pop(key)
        elif isinstance(owner, dict):
            owner["extra"] = 1
        else:
            owner.append(chance.choice(STRANGERS))
        found.append((f"{kind} {keys}", document))
    return found


# Of a changed document that follows the schema, what the reader may still find wrong.
NOT_OF_FORM = (
    *(
        "a second body",
        "mesh file",
        "no mesh format",
        "no body matches",
        "is moved by",
        "is static",
    ),
    *("must increase", "start at time 0", "no units are declared", "is not a known unit"),
    *("flattens space", "scales by 0"),
)


def test_reader_and_schema_agree_on_changed_documents(tmp_path) -> None:
    refused = accepted = 0
    for what, document in mutants(seed=1, count=400):
        valid = VALIDATOR.is_valid(document)
        found = errors(tmp_path, document)
        of_form = [e for e in found if not any(words in str(e) for words in NOT_OF_FORM)]
        assert bool(of_form) != valid, (what, [str(error) for error in found])
        refused += not valid
        accepted += valid
    assert min(refused, accepted) > 30
