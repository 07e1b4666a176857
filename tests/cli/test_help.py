"""The command as a whole process: help, version, schema, completion."""

from __future__ import annotations

import json
import re
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
from tests.cli.process import PUSHED, SAMPLES, satcheck


def test_help_advertises_what_exists() -> None:
    ran = satcheck("--help")
    assert ran.code == 0
    assert ran.out.startswith("Usage: satcheck [OPTIONS] A B [C ...]\n")
    for word in ("--clearance", "--help-all", "Exit codes", "130", "satcheck batch"):
        assert word in ran.out
    assert "--accuracy" in satcheck("--help-all").out


def test_without_a_word_it_is_the_help_and_no_pass() -> None:
    ran = satcheck()
    assert (ran.code, ran.out) == (2, satcheck("--help").out)


@pytest.mark.parametrize(
    "words",
    [
        ("--units", "mm", "batch", "box.obj"),
        ("--top", "3", "-q", "batch", "box.obj"),
        ("--limit=seconds=9", "--between", "batch", "view", "batch", "box.obj"),
    ],
)
def test_options_may_come_before_the_command(words: tuple[str, ...]) -> None:
    place = len(words) - 2
    behind = satcheck("batch", *words[:place], *words[place + 1 :])
    assert (behind.code, satcheck(*words)) == (0, behind)


@pytest.mark.parametrize(
    ("words", "advice"),
    [
        (("chek", *PUSHED), "satcheck box.obj box_pushed.stl"),
        (("bacth", "."), "satcheck batch ."),
        (("each", "."), "satcheck batch ."),
        (("report", "r.jsonl"), "satcheck view r.jsonl"),
    ],
)
def test_a_command_that_is_none_gets_advice(words: tuple[str, ...], advice: str) -> None:
    ran = satcheck(*words)
    assert ran.code in (1, 2)
    assert f"  {advice}\n" in ran.err


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
    options = [o for o in command.params if isinstance(o, click.Option) and not o.hidden]
    if len(options) + 1 >= MANY:
        others = {option.name for option in sections(options).get(OTHER, [])}
        assert others <= {"config", "no_config", "debug", "version", "color", "help_all"}


@pytest.mark.parametrize("name", [(), ("batch",)])
def test_help_is_what_is_needed_daily(name: tuple[str, ...]) -> None:
    lines = satcheck(*name, "--help").out.splitlines()
    assert len(lines) <= 70
    assert max(map(len, lines)) <= 80
    assert sum(bool(re.match(r"  (-\w, )?--[a-z]", line)) for line in lines) <= 18
    text = "".join(lines)
    assert "x<" not in text
    assert text.count("[") == text.count("]")
    whole = satcheck(*name, "--help-all").out.splitlines()
    assert {f"{heading}:" for heading in SECTIONS} <= set(whole)


def test_the_help_names_the_formats_of_the_registry() -> None:
    known = {reader.title for reader in readers().values()}
    known |= {robot.title for robot in robots().values()}
    words = " ".join(satcheck("--help").out.split())
    assert {title for title in known if title not in words} == set()


def test_options_of_settings_say_what_the_settings_are() -> None:
    options = {p.name: p for p in check_command.params if isinstance(p, click.Option)}
    own = {"timings"}  # in words of its own
    for name in (options.keys() & set(Settings.__struct_fields__)) - own:
        assert documentation(name)
        assert (options[name].help or "").startswith(documentation(name))
