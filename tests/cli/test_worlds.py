"""Several scene files in one call, and rules that apply to any input."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.cli.process import PUSHED, SAMPLES, VALIDATOR, satcheck

JSON = ("--format", "json")
ALLOWED = '[[rules]]\na = "box"\nb = "box_pushed"\nallowed = true\nreason = "glued"\n'
# Two boxes, the second one moved by `x`.
SCENE = """\
schema = "satcheck.scene/1"
units = "mm"

[[bodies]]
id = "left"
shape = {{type = "box", size = [2, 2, 2]}}

[[bodies]]
id = "right"
shape = {{type = "box", size = [2, 2, 2]}}
position = [{x}, 0, 0]
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "apart.toml").write_text(SCENE.format(x=5))
    (tmp_path / "overlap.toml").write_text(SCENE.format(x=1))
    (tmp_path / "rules.toml").write_text(ALLOWED)
    for name in PUSHED:
        shutil.copy(SAMPLES / name, tmp_path)
    return tmp_path


def pairs(report: dict[str, Any]) -> list[tuple[str, str]]:
    return [(finding["a"], finding["b"]) for finding in report["findings"]]


def test_each_scene_is_a_world_of_its_own(folder: Path) -> None:
    ran = satcheck("apart.toml", "overlap.toml", *JSON, cwd=folder)
    assert ran.code == 1
    verdicts = {asset["file"]: asset["verdict"] for asset in ran.document["assets"]}
    assert verdicts == {"apart.toml": "pass", "overlap.toml": "fail"}
    for asset in ran.document["assets"]:
        assert pairs(asset["report"]) == [("left", "right")]


def test_other_files_are_in_every_world(folder: Path) -> None:
    given = ("apart.toml", "box.obj", "overlap.toml", "--units", "mm")
    ran = satcheck(*given, *JSON, cwd=folder)
    for asset in ran.document["assets"]:
        assert [body["id"] for body in asset["report"]["bodies"]] == ["left", "right", "box"]


def test_merge_makes_one_world(folder: Path) -> None:
    ran = satcheck("apart.toml", "overlap.toml", "--merge", *JSON, cwd=folder)
    VALIDATOR.validate(ran.document)
    assert len(pairs(ran.document)) == 6
    assert ("left", "left-2") in pairs(ran.document)


def test_a_scene_and_a_file_of_rules_are_one_world(folder: Path) -> None:
    rule = '[[rules]]\na = "left"\nb = "right"\nmax_depth = 2\n'
    (folder / "rules.toml").write_text(f'schema = "satcheck.scene/1"\nbodies = []\n{rule}')
    ran = satcheck("overlap.toml", "rules.toml", *JSON, cwd=folder)
    assert (ran.code, ran.document["schema"]) == (0, "satcheck.report/1")


def test_a_wrong_scene_leaves_the_others_their_answers(folder: Path) -> None:
    (folder / "wrong.toml").write_text("schema = 5\n")
    ran = satcheck("overlap.toml", "wrong.toml", *JSON, cwd=folder)
    verdicts = {asset["file"]: asset["verdict"] for asset in ran.document["assets"]}
    assert (ran.code, verdicts) == (2, {"overlap.toml": "fail", "wrong.toml": "error"})


@pytest.mark.parametrize(
    "more", [("--certificate", "--format", "json"), ("--explain",), ("--format", "png")]
)
def test_what_is_about_one_world_is_refused(folder: Path, more: tuple[str, ...]) -> None:
    ran = satcheck("apart.toml", "overlap.toml", *more, cwd=folder)
    assert ran.code == 2
    assert "--merge" in ran.err


def test_merge_that_merges_nothing_is_told(folder: Path) -> None:
    assert "--merge has no effect" in satcheck("apart.toml", "--merge", cwd=folder).err
    merged = satcheck("apart.toml", "overlap.toml", "--merge", cwd=folder)
    assert "no effect" not in merged.err


@pytest.mark.parametrize("command", ["resolve", "suggest", "tradeoff"])
def test_other_commands_take_one_world(folder: Path, command: str) -> None:
    ran = satcheck(command, "apart.toml", "overlap.toml", cwd=folder)
    assert ran.code == 2
    assert "apart.toml and overlap.toml are scenes" in ran.err
    pair = ("--pair", "left", "right", "--limit", "run-seconds=1") if command == "tradeoff" else ()
    assert satcheck(command, "apart.toml", "overlap.toml", "--merge", *pair, cwd=folder).code != 2


def test_rules_apply_to_mesh_files(folder: Path) -> None:
    assert satcheck(*PUSHED, cwd=folder).code == 1
    ran = satcheck(*PUSHED, "--rules", "rules.toml", *JSON, cwd=folder)
    assert ran.document["summary"]["pairs"]["allowed"] == 1
    (rule,) = ran.document["rules"]
    assert (rule["reason"], rule["where"]) == ("glued", "rules.toml:1")


def test_rules_apply_to_each_asset_and_are_no_asset(folder: Path) -> None:
    rule = '[[rules]]\na = "left"\nb = "right"\nmax_depth = "2mm"\n'
    (folder / "rules.toml").write_text(f'schema = "satcheck.scene/1"\nunits = "mm"\n{rule}')
    without = satcheck("batch", ".", cwd=folder)
    assert (without.code, "rules.toml has only rules" in without.err) == (1, True)
    ran = satcheck("batch", ".", "--rules", "rules.toml", *JSON, cwd=folder)
    assert ran.code == 0, ran.err
    assert len(ran.document["assets"]) == 4
    assert ran.document["issues"] == []  # two of the four assets use it
    assert all(not asset["report"]["issues"] for asset in ran.document["assets"])


def test_a_rule_that_no_asset_needs_is_told_once(folder: Path) -> None:
    ran = satcheck(
        "batch", "apart.toml", "overlap.toml", "--rules", "rules.toml", *JSON, cwd=folder
    )
    (issue,) = ran.document["issues"]
    assert (issue["code"], issue["severity"]) == ("unused-rule", "warning")
    assert issue["message"].startswith("rules.toml:1: ")
    table = satcheck("batch", "apart.toml", "--rules", "rules.toml", cwd=folder)
    assert "rules.toml:1: the rule selects no pair" in table.out


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('[[rules]]\na = "x"\nb = "y"\nmax_dept = 1\n', "rules.toml:4: rules[0].max_dept: unknown"),
        (f"{ALLOWED}\n[[bodies]]\nid = 'a'\n", "rules.toml:7: bodies: a file of rules has no"),
        ("check_static = true\n", "rules.toml:1: check_static: unknown key"),
        ('name = "nothing"\n', 'rules.toml:1: "rules" is missing'),
        ('schema = "satcheck.scene/9"\n', "satcheck.scene/9"),
    ],
)
@pytest.mark.parametrize("given", [PUSHED, ("batch", "box.obj")])
def test_a_wrong_file_of_rules(folder: Path, text: str, told: str, given: tuple[str, ...]) -> None:
    (folder / "rules.toml").write_text(text)
    ran = satcheck(*given, "--rules", "rules.toml", cwd=folder)
    assert (ran.code, ran.out) == (2, "")
    assert told in ran.err


def test_a_report_overwrites_no_rules(folder: Path) -> None:
    ran = satcheck(*PUSHED, "--rules", "rules.toml", "-o", "rules.toml", cwd=folder)
    assert ran.code == 2
    assert (
        "would overwrite an input"
        in ran.err
        + satcheck(
            *PUSHED, "--rules", "rules.toml", "-o", "rules.toml", "--format", "json", cwd=folder
        ).err
    )
