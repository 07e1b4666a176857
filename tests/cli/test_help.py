"""The command as a whole process: help, version, schema, cache, completion."""

from __future__ import annotations

import json
import shutil
import sys
from importlib import import_module
from pathlib import Path

import click
import pytest

from satcheck.audit.settings import Settings, documentation
from satcheck.cli.click_classes import MANY, OTHER, SECTIONS, sections
from satcheck.cli.commands import COMMANDS
from satcheck.cli.commands.check import command as check_command
from satcheck.cli.commands.schema import text
from satcheck.scene.files.readers import readers, robots
from tests.cli.process import (
    SAMPLES,
    satcheck,
)


def test_help_advertises_what_exists() -> None:
    ran = satcheck("--help")
    assert ran.code == 0
    assert ran.out.startswith("Usage: satcheck [OPTIONS] A B [C ...]\n")
    for word in (
        "--clearance",
        "--accuracy",
        "Exit codes",
        "satcheck axes",
        "satcheck batch",
        "satcheck suggest",
        "satcheck tradeoff",
        "satcheck verify",
        "satcheck view",
        "_SATCHECK_COMPLETE",
    ):
        assert word in ran.out


@pytest.mark.parametrize("name", COMMANDS)
def test_help_says_of_each_command_what_its_own_help_says(name: str) -> None:
    own = import_module(f"satcheck.cli.commands.{name}").command
    assert own.get_short_help_str(limit=200) == COMMANDS[name]


def test_usage_errors_name_the_command_as_typed() -> None:
    assert "Try 'satcheck --help' for help" in satcheck("--nonsense").err


def test_version() -> None:
    ran = satcheck("--version")
    assert ran.code == 0
    assert ran.out.startswith("satcheck 0.")


def test_schema_command_prints_the_schema() -> None:
    assert satcheck("schema").document == json.loads(text())


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_script(shell: str) -> None:
    ran = satcheck(env={"_SATCHECK_COMPLETE": f"{shell}_source"})
    assert ran.code == 0
    assert "_SATCHECK_COMPLETE" in ran.out


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("satcheck --acc", "plain,--accuracy"),
        ("satcheck --accuracy o", "plain,obb"),
        ("satcheck b", "file,b"),
        ("satcheck box.obj --exp", "plain,--explain"),
        ("satcheck ba", "plain,baseline"),
        ("satcheck baseline w", "plain,write"),
    ],
)
def test_completion(words: str, expected: str) -> None:
    shell = {"_SATCHECK_COMPLETE": "bash_complete", "COMP_WORDS": words}
    ran = satcheck(env={**shell, "COMP_CWORD": str(len(words.split()) - 1)})
    assert expected in ran.out.splitlines()


def test_a_file_named_like_a_command_can_be_checked(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "box.obj", tmp_path / "config")
    ran = satcheck("./config", str(SAMPLES / "box.obj"), cwd=tmp_path)
    assert ran.code == 2  # no ending: an unknown format, but a path
    assert "config" in ran.err
    assert sys.executable not in ran.err


@pytest.mark.parametrize("name", ["check", *COMMANDS])
def test_every_option_of_much_help_has_a_heading(name: str) -> None:
    """Those of no section are the ones of every program."""
    command = import_module(f"satcheck.cli.commands.{name}").command
    options = [option for option in command.params if isinstance(option, click.Option)]
    if len(options) + 1 >= MANY:
        others = {option.name for option in sections(options).get(OTHER, [])}
        assert others <= {"config", "no_config", "debug", "version"}


def test_help_has_headings_and_stays_short() -> None:
    lines = satcheck("--help").out.splitlines()
    for heading in SECTIONS:
        assert f"{heading}:" in lines
    assert len(lines) <= 150
    assert max(map(len, lines)) <= 80
    text = "".join(lines)
    assert "x<" not in text
    assert text.count("[") == text.count("]")


def test_the_help_names_the_formats_of_the_registry() -> None:
    known = {reader.title for reader in readers().values()}
    known |= {robot.title for robot in robots().values()}
    words = " ".join(satcheck("--help").out.split())
    assert {title for title in known if title not in words} == set()


def test_options_of_settings_say_what_the_settings_are() -> None:
    options = {p.name: p for p in check_command.params if isinstance(p, click.Option)}
    own = {"cache", "timings", "seconds_per_file", "megabytes_per_file"}  # in words of their own
    for name in (options.keys() & set(Settings.__struct_fields__)) - own:
        assert documentation(name)
        assert (options[name].help or "").startswith(documentation(name))
