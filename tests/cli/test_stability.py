"""`satcheck stability` as a whole process: its documents and exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from satcheck.cli.formats.schema import text
from tests.audit.shapes import unit_box, write
from tests.cli.process import APART, PUSHED, satcheck

SCHEMA = json.loads(text("stability"))


def test_a_stable_pair_exits_with_zero() -> None:
    ran = satcheck("stability", *PUSHED)
    assert ran.code == 0, ran.err
    assert "box.obj against box_pushed.stl: penetrating, depth 1" in ran.out
    assert "nothing changed beyond its bound" in ran.out


def test_it_says_where_a_plain_check_says_touching(tmp_path: Path) -> None:
    a, b = write(tmp_path, a=unit_box(), b=unit_box(1.0 + 1e-17))
    assert "A plain check says" not in satcheck("stability", str(a), str(b)).out
    a, b = write(tmp_path, a=unit_box(), b=unit_box(1.0 + 2.0**-52))
    ran = satcheck("stability", str(a), str(b))
    assert "a.obj against" in ran.out
    assert "separated, gap 2.22045e-16" in ran.out
    assert "A plain check says touching: that is within the tolerance" in ran.out
    assert "1 touching." in satcheck(str(a), str(b)).out


def test_the_document_follows_its_schema() -> None:
    Draft202012Validator.check_schema(SCHEMA)
    ran = satcheck("stability", *APART, "--format", "json", "--samples", "2", "--seed", "7")
    assert ran.code == 0, ran.err
    Draft202012Validator(SCHEMA).validate(ran.document)
    assert ran.document["verdict"] == "stable"
    again = satcheck("stability", *APART, "--format", "json", "--samples", "2", "--seed", "7")
    assert again.out == ran.out


def test_the_schema_is_printed() -> None:
    assert satcheck("schema", "stability").document == SCHEMA


def test_explain_lists_every_variant() -> None:
    ran = satcheck("stability", *APART, "--samples", "1", "--explain")
    assert ran.out.count("(same)") + ran.out.count("(within)") == 8


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("box.obj",), "give two mesh files, not 1"),
        (("box.obj", "missing.obj"), "no such file"),
        (("box.obj", "workcell.json"), "two mesh files"),
        (("box.obj", "cube.off", "--samples", "0"), "--samples"),
        (("box.obj", "cube.off", "--format", "json", "-o", "cube.off"), "overwrite an input"),
    ],
)
def test_misuse_exits_with_two(arguments: tuple[str, ...], said: str) -> None:
    ran = satcheck("stability", *arguments)
    assert ran.code == 2
    assert said in ran.err
    assert ran.out == ""
