"""Options from satcheck.toml or [tool.satcheck] of pyproject.toml."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from junitparser import JUnitXml

from satcheck.cli.config import options_of_commands
from tests.cli.process import PUSHED, SAMPLES, VALIDATOR, environment, satcheck
from tests.cli.test_startup import imported

JSON = ("--format", "json")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project with two boxes, and a folder in it."""
    (tmp_path / "sub").mkdir()
    for name in PUSHED:
        shutil.copy(SAMPLES / name, tmp_path)
    return tmp_path


def config(folder: Path, text: str, name: str = "satcheck.toml") -> None:
    (folder / name).write_text(text, encoding="utf-8")


def in_effect(*arguments: str, cwd: Path) -> dict[str, tuple[str, str]]:
    """Key -> (value, source), as `config show` prints them."""
    ran = satcheck("config", "show", *arguments, cwd=cwd)
    assert ran.code == 0, ran.err
    lines = (line.rsplit("  # ", 1) for line in ran.out.splitlines()[1:])
    split = ((value.split(" = ", 1), source) for value, source in lines)
    return {key: (value.strip(), source) for (key, value), source in split}


def test_a_config_file_gives_options_and_the_report_says_so(folder: Path) -> None:
    config(folder, "depth = false\ntolerance = 2\nno-timings = true\n")
    ran = satcheck(*PUSHED, *JSON, cwd=folder)
    VALIDATOR.validate(ran.document)
    assert (ran.code, ran.document["settings"]["tolerance"]) == (0, 2.0)
    options = {"depth": False, "tolerance": 2, "no-timings": True}
    assert ran.document["config"] == {"file": "satcheck.toml", "options": options}
    assert '"microseconds"' not in ran.out
    table = satcheck(*PUSHED, cwd=folder)
    assert "Options of satcheck.toml: " in table.out


def test_the_command_line_wins(folder: Path) -> None:
    config(folder, 'tolerance = 2\nfail-on = "note"\ndepth = false\n')
    ran = satcheck(*PUSHED, "--tolerance", "0", "--depth", *JSON, cwd=folder)
    assert ran.document["settings"]["tolerance"] == 0.0
    assert ran.document["settings"]["depth"] is True
    assert ran.document["config"]["options"] == {"fail-on": "note"}
    assert satcheck(*PUSHED, "--no-config", *JSON, cwd=folder).document["config"] is None


def test_the_name_of_a_report_wins_over_a_format(folder: Path) -> None:
    config(folder, 'format = "csv"\n')
    assert satcheck(*PUSHED, cwd=folder).out.startswith("\ufeffa,b,")
    satcheck(*PUSHED, "-o", "report.json", cwd=folder)
    assert json.loads((folder / "report.json").read_text())["schema"] == "satcheck.report/1"


@pytest.mark.parametrize("command", [(), ("batch",)])
def test_paths_are_relative_to_the_config_file(folder: Path, command: tuple[str, ...]) -> None:
    rule = '[[rules]]\na = "box"\nb = "box_pushed"\nallowed = true\nreason = "glued"\n'
    config(folder, rule, "allowed.toml")
    config(folder, 'rules = ["allowed.toml"]\noutput = "report.json"\n')
    named = ("--config", "../satcheck.toml")
    ran = satcheck(*command, *named, *(f"../{name}" for name in PUSHED), cwd=folder / "sub")
    assert ran.code in (0, 3), ran.err
    document = json.loads((folder / "report.json").read_text())
    report = document["assets"][0]["report"] if command else document
    assert report["rules"][0]["where"] == "../allowed.toml:1"
    assert report["config"]["file"] == "../satcheck.toml"


def test_the_path_of_a_robot_is_relative_to_the_config_file(folder: Path) -> None:
    config(folder, "elbow\n0\n0.1\n", "poses.csv")
    config(folder, 'path = "poses.csv"\n')
    arm = SAMPLES / "arm.urdf"
    ran = satcheck(str(arm), str(arm.with_suffix(".srdf")), *JSON, cwd=folder / "sub")
    assert ran.code == 0, ran.err
    assert [motion["kind"] for motion in ran.document["motions"]] == ["joints"]


def test_the_nearest_file_counts(folder: Path) -> None:
    config(folder, "jobs = 1\n")
    assert in_effect(cwd=folder / "sub")["jobs"] == ("1", "../satcheck.toml:1")
    config(folder / "sub", "[project]\nname = 'x'\n[tool.satchecks]\njobs = 4\n", "pyproject.toml")
    assert in_effect(cwd=folder / "sub")["jobs"] == ("1", "../satcheck.toml:1")
    for table in ("[tool.satcheck]\njobs = 2\n", "[tool]\nsatcheck = {jobs = 2}\n"):
        config(folder / "sub", table, "pyproject.toml")
        value, source = in_effect(cwd=folder / "sub")["jobs"]
        assert (value, source.split(":")[0]) == ("2", "pyproject.toml")
    config(folder / "sub", "jobs = 3\n")
    assert in_effect(cwd=folder / "sub")["jobs"] == ("3", "satcheck.toml:1")
    assert in_effect("--config", "../satcheck.toml", cwd=folder / "sub")["jobs"][0] == "1"
    assert in_effect("--no-config", cwd=folder / "sub")["jobs"] == ("0", "default")


def test_a_link_that_leads_nowhere_is_not_passed_over(folder: Path) -> None:
    """It may hold what makes a check fail, such as a clearance."""
    config(folder, "depth = false\n")
    (folder / "sub" / "satcheck.toml").symlink_to("gone.toml")
    ran = satcheck(*(f"../{name}" for name in PUSHED), cwd=folder / "sub")
    assert ran.code == 2
    assert "satcheck.toml: no such file" in ran.err
    assert "[bad-config]" in ran.err


def test_show_says_where_options_come_from(folder: Path) -> None:
    config(folder, 'changed-since = "main"\nno-timings = true\nstate = ["a", "b"]\n')
    shown = in_effect("--no-depth", "--clearance", "2mm", cwd=folder)
    assert shown["no-timings"] == ("true", "satcheck.toml:2")
    assert shown["state"] == ('["a", "b"]', "satcheck.toml:3")
    assert shown["depth"] == ("false", "command line")
    assert shown["clearance"] == ('"2mm"', "command line")
    assert shown["accuracy"] == ('"exact"', "default")
    assert "changed-since" not in shown
    assert in_effect("batch", cwd=folder)["changed-since"] == ('"main"', "satcheck.toml:1")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "\nfail_on = 'note'\n",
            "satcheck.toml:2: fail_on: no such option (did you mean 'fail-on'?",
        ),
        ("fail-on = 'never'\n", "satcheck.toml:1: fail-on: 'never' is not one of"),
        ("depth = 1\n", "satcheck.toml:1: depth: true or false expected"),
        ("tolerance = true\n", "satcheck.toml:1: tolerance: a text or a number expected"),
        ("jobs = 1.5\n", "satcheck.toml:1: jobs: a whole number of at least 0 is expected (--no"),
        ("jobs = 'x'\n", "satcheck.toml:1: jobs: a whole number of at least 0 is expected (--no"),
        ("jobs = -1\n", "satcheck.toml:1: jobs: a whole number of at least 0 is expected (--no"),
        ("width = 1\n", "width: a number above 0 and below 1 is expected (--no"),
        ("clearance = '2 miles'\n", "satcheck.toml:1: clearance: "),
        ("rules = [['a']]\n", "satcheck.toml:1: rules: a text or a number expected"),
        ("between = ['a', 'b']\n", "satcheck.toml:1: between: lists in a list expected"),
        ("between = [['a', 3]]\n", "satcheck.toml:1: between: lists in a list expected"),
        ("between = [['a']]\n", "satcheck.toml:1: between: Takes 2 values but 1 was given"),
        ("[each]\njobs = 1\n", "satcheck.toml:1: each: no such option"),
        ("debug = true\n", "satcheck.toml:1: debug: no such option"),
        ("jobs = \n", "satcheck.toml:1: not well-formed TOML: "),
        ("\nclearance = 1mm\n", 'satcheck.toml:2: a length with a unit stands in quotes: "1mm"'),
        ("[[rule]]\na = 'x'\n", "satcheck.toml:1: rule: no such option (did you mean 'rules'?)"),
    ],
)
@pytest.mark.parametrize("command", [(), ("batch",)])
def test_a_wrong_config_is_refused(
    folder: Path, text: str, told: str, command: tuple[str, ...]
) -> None:
    config(folder, text)
    ran = satcheck(*command, *PUSHED, cwd=folder)
    assert (ran.code, ran.out) == (2, "")
    assert told in ran.err
    assert "[bad-config]" in ran.err
    assert satcheck(*command, "--no-config", *PUSHED, cwd=folder).code in (0, 1)


def test_all_wrong_keys_are_told(folder: Path) -> None:
    config(folder, "one = 1\ntwo = 2\n")
    ran = satcheck(*PUSHED, cwd=folder)
    assert "satcheck.toml:1: one" in ran.err
    assert "satcheck.toml:2: two" in ran.err


def test_config_and_no_config_contradict_each_other(folder: Path) -> None:
    config(folder, "")
    for options in (
        ("--no-config", "--config", "satcheck.toml"),
        ("--config", "satcheck.toml", "--no-config"),
    ):
        assert satcheck(*PUSHED, *options, cwd=folder).code == 2


def test_help_needs_no_sound_config(folder: Path) -> None:
    config(folder, "wrong")
    assert satcheck("--help", cwd=folder).code == 0
    assert satcheck("batch", "--help", cwd=folder).code == 0
    assert satcheck("schema", cwd=folder).code == 0


def test_the_schema_knows_every_option() -> None:
    document = json.loads(satcheck("schema", "config").out)
    assert document["properties"].keys() == options_of_commands().keys()
    sound: list[dict[str, Any]] = [
        {"tolerance": 0.5}, {"tolerance": "0.5 mm"}, {"rules": "a"}, {"rules": ["a"]},
        {"no-timings": True}, {"jobs": 0}, {"fail-on": "note"}, {"width": 0.5},
    ]  # fmt: skip
    wrong: list[dict[str, Any]] = [
        {"tolerance": -1}, {"fail_on": "note"}, {"no-timings": 1}, {"jobs": -1}, {"width": 1},
    ]  # fmt: skip
    check = Draft202012Validator(document)
    assert [values for values in sound if not check.is_valid(values)] == []
    assert [values for values in wrong if check.is_valid(values)] == []


def test_pairs_of_names_come_from_the_file(folder: Path) -> None:
    shutil.copy(SAMPLES / "cube.off", folder)
    config(folder, 'between = [["box", "cube"]]\n')
    check = Draft202012Validator(json.loads(satcheck("schema", "config").out))
    assert check.is_valid({"between": [["box", "cube"]]})
    assert not check.is_valid({"between": ["box", "cube"]})
    ran = satcheck(*PUSHED, "cube.off", *JSON, cwd=folder)
    VALIDATOR.validate(ran.document)
    assert (ran.code, ran.document["summary"]["pairs"]["allowed"]) == (0, 2)
    assert ran.document["config"]["options"] == {"between": ["box cube"]}
    config(folder, 'between = [["box", "gone"]]\n')
    ran = satcheck(*PUSHED, cwd=folder)
    assert (ran.code, "satcheck.toml:1: between: no body is gone" in ran.err) == (2, True)


def test_ci_formats_name_the_config_file(folder: Path) -> None:
    config(folder, "no-timings = true\n")
    line = "Options of satcheck.toml: no-timings = true"
    sarif = json.loads(satcheck(*PUSHED, "--format", "sarif", cwd=folder).out)
    (note,) = sarif["runs"][0]["invocations"][0]["toolConfigurationNotifications"]
    assert note["message"]["text"] == line
    suite = next(iter(JUnitXml.fromstring(
        satcheck(*PUSHED, "--format", "junit", cwd=folder).out.encode()
    )))  # fmt: skip
    assert [prop.value for prop in suite.properties()] == [line]  # type: ignore[no-untyped-call]
    for form in ("github", "markdown"):
        assert "Options of satcheck" in satcheck(*PUSHED, "--format", form, cwd=folder).out


def test_poses_state_the_config_file(folder: Path) -> None:
    for name in ("arm.urdf", "arm_beam.stl", "arm_finger.obj"):
        shutil.copy(SAMPLES / name, folder)
    config(folder, "sample = 3\n")
    ran = satcheck("arm.urdf", *JSON, cwd=folder)
    assert ran.document["config"] == {"file": "satcheck.toml", "options": {"sample": 3}}


def test_assets_are_all_checked_after_a_change_of_the_config(folder: Path) -> None:
    def git(*words: str) -> None:
        names = ("-c", "user.name=t", "-c", "user.email=t@example.org")
        subprocess.run(["git", *names, *words], cwd=folder, env=environment(), check=True)

    config(folder, "jobs = 1\n")
    git("init", "-q")
    git("add", ".")
    git("commit", "-qm", "all")
    assert "no asset changed" in satcheck("batch", ".", "--changed-since", "HEAD", cwd=folder).err
    config(folder, "jobs = 2\n")
    ran = satcheck("batch", ".", "--changed-since", "HEAD", *JSON, cwd=folder)
    assert "satcheck.toml changed since HEAD" in ran.err
    assert len(ran.document["assets"]) == 2


def test_a_project_that_does_not_name_satcheck_costs_no_parser(folder: Path) -> None:
    text = "[project]\nname = 'a'\n[tool.ruff]\nline-length = 9\n"
    config(folder, text, "pyproject.toml")
    names = imported(*PUSHED, code=1, cwd=folder)
    assert "tomllib" not in names


def test_a_length_with_a_unit_matters_only_where_there_is_a_pair(folder: Path) -> None:
    config(folder, 'fail-on = "error"\nclearance = "2mm"\n')
    assert satcheck("batch", ".", cwd=folder).code == 0
    told = "satcheck.toml:2: clearance 2mm: no units are declared"
    scene = '[[bodies]]\nid = "{0}"\nmesh = "{1}"\n'
    pair = [scene.format(*names) for names in zip("ab", PUSHED, strict=True)]
    config(folder, "".join(['schema = "satcheck.scene/1"\n', *pair]), "pair.toml")
    for files in (PUSHED, ("batch", "pair.toml")):
        ran = satcheck(*files, cwd=folder)
        shown = " ".join(f"{ran.out} {ran.err}".split())  # of several assets a table has it
        assert (ran.code, told in shown) == (2, True), shown
    given = satcheck(*PUSHED, "--clearance", "3mm", cwd=folder)
    assert "--clearance 3mm: no units are declared" in given.err
    config(folder, 'clearance = "2mm"\nunits = "mm"\n')
    assert satcheck(*PUSHED, cwd=folder).code == 1


@pytest.mark.parametrize(
    "text",
    [
        'output = "report.json"',
        "exit-zero = true",
        "allow-outside = true",
        "limit = 'seconds=3600'",
        "limit = ['seconds=5', 'megabytes=65536']",
        "budget = 3",
    ],
)
def test_a_file_that_was_merely_found_does_not_do_so(folder: Path, text: str) -> None:
    """Who wrote it may not be the one who calls; who names it knows what it does."""
    config(folder, f"{text}\n")
    ran = satcheck(*PUSHED, cwd=folder)
    assert (ran.code, ran.out) == (2, "")
    assert "satcheck.toml:1: " in ran.err
    assert "--config satcheck.toml" in ran.err
    assert satcheck(*PUSHED, "--config", "satcheck.toml", cwd=folder).code < 2


def test_smaller_limits_of_a_file_that_was_found_count(folder: Path) -> None:
    config(folder, "limit = 'seconds=30, scene-seconds=9'\nexit-zero = false\n")
    assert satcheck(*PUSHED, cwd=folder).code == 1


def test_what_a_found_file_decides_with_is_told_on_stderr(folder: Path) -> None:
    config(folder, "tolerance = 5\njobs = 1\n")
    ran = satcheck("-q", *PUSHED, cwd=folder)
    assert (ran.code, ran.err) == (0, "satcheck: satcheck.toml sets tolerance\n")
    for more in (("--config", "satcheck.toml"), ("--tolerance", "6")):
        ran = satcheck("-q", *more, *PUSHED, cwd=folder)
        assert (ran.code, ran.err) == (0, "")
