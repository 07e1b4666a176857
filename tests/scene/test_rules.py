"""Selectors and what a rule may say."""

from __future__ import annotations

import math

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import Rule, Selector

ANY = Selector("*")


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
    assert Selector(text).matches(body, groups)


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
    assert not Selector(text).matches(body, groups)


@pytest.mark.parametrize(
    "body", ["bolt", "a*b?", "[1]", "]", "group:x", "[!]", "\n[\n]", "a[b]c[", "^", "[^]"]
)
def test_exactly_one_id(body: str) -> None:
    selector = Selector.exactly(body)
    assert selector.only == body
    assert selector.matches(body, ())
    assert not selector.matches(body + "x", (body,))


@pytest.mark.parametrize("text", ["a*", "a?", "[ab]", "[!a]", "group:[a-c]"])
def test_several_may_match(text: str) -> None:
    assert Selector(text).only is None


def test_the_only_group() -> None:
    assert Selector("group:links").only == "links"


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
