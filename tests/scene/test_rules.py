"""Selectors and what a rule may say."""

from __future__ import annotations

import math
import re
from fnmatch import translate
from itertools import product

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import Rule, Selector
from satcheck.scene.words import with_closed_brackets
from tests.report.books import Subject

ANY = Selector("*")


def matches(text: str, body: str, groups: tuple[str, ...] = ()) -> bool:
    return bool(Selector(text).select([Subject(body, groups)]))


@pytest.mark.parametrize(
    ("text", "body", "groups"),
    [
        ("bolt", "bolt", ()),
        ("bolt*", "bolt-2", ()),
        ("arm/*", "arm/link/1", ()),
        ("bolt-?", "bolt-7", ("bolts",)),
        ("bolt-[0-4]", "bolt-3", ()),
        ("[*]", "*", ()),
        ("group:links", "x", ("links",)),
        ("group:l*", "x", ("other", "links")),
        ("*", "group:x", ()),
    ],
)
def test_matches(text: str, body: str, groups: tuple[str, ...]) -> None:
    assert matches(text, body, groups)


@pytest.mark.parametrize(
    ("text", "body", "groups"),
    [
        ("bolt", "bolts", ()),
        ("Bolt", "bolt", ()),
        ("bolt-[!0-4]", "bolt-3", ()),
        ("[*]", "x", ()),
        ("links", "x", ("links",)),
        ("group:links", "links", ()),
        ("group:*", "x", ()),
        ("group:x", "group:x", ()),
    ],
)
def test_does_not_match(text: str, body: str, groups: tuple[str, ...]) -> None:
    assert not matches(text, body, groups)


@pytest.mark.parametrize(
    "body", ["bolt", "a*b?", "[1]", "]", "group:x", "[!]", "\n[\n]", "a[b]c[", "^", "[^]"]
)
def test_exactly_one_id(body: str) -> None:
    selector = Selector.exactly(body)
    assert matches(selector.text, body)
    assert not matches(selector.text, body + "x", (body,))


def test_an_id_that_is_the_text_comes_before_the_glob() -> None:
    ids = ["br0", "br[0]", "br1", "a*", "ab"]
    assert Selector("br[0]").choose(ids) == ("br[0]",)
    assert Selector("br[1]").choose(ids) == ["br1"]
    assert Selector("a*").choose(ids) == ("a*",)
    assert Selector("group:br[0]").choose(ids) == ("br[0]",)
    bodies = [Subject("br0"), Subject("br[0]", ("a[1]",)), Subject("x", ("a1",))]
    assert Selector("br[0]").select(bodies) == bodies[1:2]
    assert Selector("group:a[1]").select(bodies) == bodies[1:2]


@pytest.mark.parametrize("body", ["br[0]", "a*", "group:x", "group:[g]"])
def test_an_id_spelt_out_comes_before_one_that_is_the_text(body: str) -> None:
    """So a rule that satcheck writes about a body is about no other."""
    selector = Selector.exactly(body)
    assert selector.choose([selector.text, body]) == (body,)


@pytest.mark.parametrize("text", ["", "group:"])
def test_an_empty_selector_is_refused(text: str) -> None:
    with pytest.raises(SatcheckError, match="is empty") as refused:
        Selector(text)
    assert refused.value.code == "bad-rule"


@pytest.mark.parametrize(
    "keys",
    [
        {},
        {"reason": "because"},
        {"max_depth": -1.0},
        {"max_volume": math.inf},
        {"clearance": math.nan},
        {"tolerance": -0.1},
        {"severity": "fatal"},
        {"allowed": True, "max_depth": 1.0},
    ],
)
def test_a_rule_that_makes_no_sense_is_refused(keys: dict) -> None:
    with pytest.raises(SatcheckError) as refused:
        Rule(a=ANY, b=ANY, **keys)
    assert refused.value.code == "bad-rule"


def test_the_name_says_where_or_what() -> None:
    assert Rule(a=ANY, b=Selector("bolt"), allowed=True).name == "* and bolt"
    assert Rule(a=ANY, b=ANY, allowed=True, where="scene.toml:12").name == "scene.toml:12"


def test_brackets_are_closed_without_a_change_of_meaning() -> None:
    texts = ["".join(text) for n in range(4) for text in product("[]!a", repeat=n)]
    for n in range(5):
        for glob in map("".join, product("[]!a", repeat=n)):
            before, after = (re.compile(translate(g)) for g in (glob, with_closed_brackets(glob)))
            assert all(bool(before.match(t)) == bool(after.match(t)) for t in texts), glob


def test_many_brackets_that_nothing_closes_take_no_minutes() -> None:
    assert with_closed_brackets("[" * 3 + "a") == "[[][[][[]a"
    assert not matches("[" * 100_000, "[")
    assert matches("*" + "[" * 100_000, "[" * 100_001)
