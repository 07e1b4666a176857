"""Calls that are read without click: as click reads them, or not at all."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from satcheck.cli import checking
from satcheck.cli.checking import Choices
from satcheck.cli.command import satcheck
from satcheck.cli.plain import FLAGS, VALUES, plain_choices

VALUE_OF = {"form": "table", "output": "report.json", "jobs": "3"}
OPTIONS = [(flag,) for flag in FLAGS] + [(name, VALUE_OF[VALUES[name]]) for name in VALUES]


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def read_by_click(arguments: list[str], monkeypatch: pytest.MonkeyPatch) -> Choices:
    read: list[Choices] = []
    with monkeypatch.context() as patch:
        patch.setattr(checking, "run", read.append)
        satcheck.main(arguments, prog_name="satcheck", standalone_mode=False)
    return read[0]


def test_every_option_alone_and_with_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[list[str]] = [
        [],
        *map(list, OPTIONS),
        *([*a, *b] for a, b in itertools.permutations(OPTIONS, 2)),
    ]
    for options in calls:
        for arguments in (["a.obj", *options, "b.stl"], [*options, "scene.json"]):
            assert plain_choices(arguments) == read_by_click(arguments, monkeypatch), arguments


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["--no-depth"],
        ["--help"],
        ["a.obj", "--version"],
        ["resolve", "a.json"],
        ["a.obj", "--clearance", "1"],
        ["a.obj", "--format=json"],
        ["a.obj", "-j2"],
        ["a.obj", "--no-dep"],
        ["a.obj", "--jobs", "-1"],
        ["a.obj", "--jobs", "\N{ARABIC-INDIC DIGIT TWO}"],
        ["a.obj", "--jobs", 5000 * "1"],
        ["a.obj", "--jobs"],
        ["a.obj", "--format", "xml"],
        ["a.obj", "-o", "-"],
        ["a.obj", "-o", "."],
        ["a.obj", ""],
        ["a.obj", "--", "--depth"],
    ],
)
def test_what_is_left_to_click(arguments: list[str]) -> None:
    assert plain_choices(arguments) is None
