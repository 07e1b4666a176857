"""JSON in C++ is what the json module makes of it, or nothing."""

from __future__ import annotations

import json
import random

import pytest

from satcheck.scene._readers import read_json

PLAIN = [
    "null",
    " [ ] ",
    "{}",
    '\t{"a" : [1, -0, 12.5e-3, -0.0, 1E+2, 123456789012345678]}\r\n',
    '{"b": {"c": [[], {}, true, false]}, "d": []}',
    '["", "plain", "\\"\\\\\\/\\b\\f\\n\\r\\t", "\\u00e9\\u20AC\\ud83d\\ude00\\u0000", "é€😀"]',
    '{"\\u0061": 1, "b\\n": 2}',
    "[" * 90 + "]" * 90,
    "[0.1, 2.2250738585072014e-308, 5e-324, 1.7976931348623157e308, 9007199254740993.0]",
]
# What json.loads refuses, or reads in ways of its own.
LEFT_TO_JSON = [
    *(
        "",
        " ",
        "nul",
        "NaN",
        "-Infinity",
        "tru",
        "[1,]",
        "[1 2]",
        "[",
        "[1",
        '{"a"}',
        '{"a":}',
        '{"a":1,}',
    ),
    *(
        "{1: 2}",
        "01",
        "1.",
        ".5",
        "-",
        "+1",
        "1e",
        "1e400",
        "1e-400",
        "1 2",
        '"',
        '"a',
        '"\n"',
        '"\\x"',
        '"\\u12g4"',
    ),
    *(
        '"\\ud800"',
        '"\\ud800\\u0041"',
        '"\\udc00"',
        '"\\u12',
        "\ufeff[]",
        "1234567890123456789",
        "[" * 200 + "]" * 200,
    ),
]


@pytest.mark.parametrize("text", PLAIN)
def test_plain_text(text: str) -> None:
    found = read_json(text)
    assert found is not None
    assert repr(found[0]) == repr(json.loads(text))  # repr: -0 is not -0.0, nor 1 1.0
    assert not found[1]


@pytest.mark.parametrize("text", LEFT_TO_JSON)
def test_the_rest_is_left_to_the_json_module(text: str) -> None:
    assert read_json(text) is None


def test_the_last_of_repeated_keys_counts() -> None:
    assert read_json('[{"a": 1, "b": 2, "a": 3}]') == ([{"a": 3, "b": 2}], True)
    assert read_json('[{"a": 1}, {"a": 1}]') == ([{"a": 1}, {"a": 1}], False)


def test_damaged_text_is_never_read_otherwise() -> None:
    source = random.Random(5)
    whole = json.dumps({"a": [1.5, -2, "x\n\u20ac", None, True], "b": {"c": {}, "d": []}})
    for _ in range(3000):
        at = source.randrange(len(whole))
        text = (
            whole[:at]
            + source.choice('{}[]",:0-.e\\u \x01tn') * source.randrange(2)
            + whole[at + 1 :]
        )
        found = read_json(text)
        if found is not None:
            assert repr(found[0]) == repr(json.loads(text)), text
