"""The formats of CI systems, each read back by a reader that is not ours where there is one."""

from __future__ import annotations

import csv
import io
import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from urllib.parse import quote

import pytest
from junitparser import Failure, JUnitXml
from msgspec.structs import replace
from sarif_pydantic import Sarif

from satcheck.cli.formats.ci.problems import problems, uri
from satcheck.cli.formats.registry import formats, pieces
from satcheck.report.report import BodyReport, Finding, Report
from tests.cli.process import PUSHED, SAMPLES, satcheck
from tests.cli.reports import (
    BLOCK,
    HIT,
    MISSING,
    OPEN,
    PENETRATING,
    SEPARATED,
    TOUCHING,
    UNDECIDED,
    report,
)

TOUCH = replace(TOUCHING, severity="note")
DEEPER = replace(PENETRATING, id="block|deeper", b="deeper", depth=2.0, depth_bounds=(2.0, 2.0))
NAMES = ("block", "block_pushed", "deeper", "far", "flush", "soup")


def render(reports: Mapping[str, Report], form: str) -> str:
    return "".join(pieces(reports, form))


def scene_report(*findings: Finding) -> Report:
    bodies = tuple(replace(BLOCK, id=name, name=name, file=f"{name}.obj") for name in NAMES)
    return report(*findings, bodies=bodies, issues=(OPEN, MISSING))


MIXED = scene_report(SEPARATED, TOUCH, UNDECIDED, PENETRATING, DEEPER)


def of_block(body: BodyReport, form: str) -> str:
    """A report about a body against itself."""
    finding = replace(PENETRATING, a=body.id, b=body.id)
    return render({"all": report(finding, bodies=(body,))}, form)


def test_the_worst_problem_comes_first() -> None:
    listed = problems({"all": MIXED})
    assert [problem.level for problem in listed] == ["error"] * 3 + ["warning"] * 2 + ["note"]
    assert [problem.kind for problem in listed] == [
        "overlap", "overlap", "unreadable", "undecided", "not-closed", "touch"
    ]  # fmt: skip
    assert listed[0].bodies == ("block", "deeper")


def test_a_hit_on_the_way_is_a_problem_of_its_own_kind() -> None:
    hit = replace(HIT, b="far")
    assert next(problem.kind for problem in problems({"all": scene_report(hit)})) == "motion"


def test_sarif() -> None:
    run = Sarif.model_validate_json(render({"all": MIXED}, "sarif")).runs[0]
    assert run.results is not None
    assert [result.level for result in run.results] == ["error"] * 3 + ["warning"] * 2 + ["note"]
    rules = run.tool.driver.rules
    assert rules is not None
    for result in run.results:
        assert rules[result.rule_index or 0].id == result.rule_id
        assert result.locations
        assert result.locations[0].physical_location
    first = json.loads(render({"all": MIXED}, "sarif"))["runs"][0]["results"][0]
    assert first["partialFingerprints"] == {"satcheckId/v1": DEEPER.id}
    physical = first["locations"][0]["physicalLocation"]
    assert physical == {"artifactLocation": {"uri": "block.obj"}, "region": {"startLine": 1}}
    other = first["relatedLocations"][0]["logicalLocations"]
    assert other == [{"fullyQualifiedName": "deeper", "kind": "object"}]


def test_sarif_without_problems_has_a_run_without_results() -> None:
    document = json.loads(render({"all": report(SEPARATED)}, "sarif"))
    assert document["runs"][0]["results"] == []


def test_sarif_keeps_the_worst_results_within_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("satcheck.cli.formats.ci.sarif.MOST_RESULTS", 4)
    run = json.loads(render({"all": MIXED}, "sarif"))["runs"][0]
    assert [result["level"] for result in run["results"]] == ["error"] * 3 + ["warning"]
    notes = run["invocations"][0]["toolExecutionNotifications"]
    assert notes[0]["message"]["text"].startswith("2 more results")


def test_junit() -> None:
    document = JUnitXml.fromstring(render({"all": MIXED}, "junit").encode())
    assert (document.tests, document.failures, document.errors) == (6, 2, 2)
    failed = [case.name for case in next(iter(document)) if Failure in map(type, case.result)]
    assert failed == ["block and block_pushed", "block and deeper"]


def test_junit_drops_what_xml_cannot_hold() -> None:
    body = replace(BLOCK, id="a\x00<b>", file="a&b.obj")
    finding = replace(SEPARATED, a=body.id, b=body.id)
    document = JUnitXml.fromstring(
        render({"all": report(finding, bodies=(body,))}, "junit").encode()
    )
    case = next(iter(next(iter(document))))
    assert (case.classname, case.name) == ("a&b.obj", "a\ufffd<b> and a\ufffd<b>")


def test_github_annotations() -> None:
    lines = render({"all": MIXED}, "github").splitlines()
    assert lines[0].startswith("::error file=block.obj,line=1,title=satcheck%3A overlap::block and")
    assert [line.split(" ")[0] for line in lines[3:6]] == ["::warning", "::warning", "::notice"]
    assert lines[-1].startswith("satcheck: all: ")
    only = render({"satcheck": MIXED}, "github").splitlines()[-1]
    assert only.startswith(
        "satcheck: FAIL: 2 of 5 pairs overlap; worst: block and deeper overlap (2 to pull apart). "
    )


def test_a_name_cannot_forge_an_annotation() -> None:
    body = replace(BLOCK, id="a\n::error::x", file="a,b:c.obj")
    text = render(
        {"all": report(replace(PENETRATING, a=body.id, b=body.id), bodies=(body,))}, "github"
    )
    assert len(text.splitlines()) == 2
    assert "file=a%2Cb%3Ac.obj" in text.replace("%252C", "%2C").replace("%253A", "%3A")


def test_an_annotation_names_the_plain_path() -> None:
    text = of_block(replace(BLOCK, file="50% a.obj"), "github")
    assert "file=50%25 a.obj,line=1" in text


def test_an_incomplete_suite_has_an_error() -> None:
    summary = replace(report(SEPARATED).summary, verdict="incomplete")
    incomplete = replace(report(SEPARATED), summary=summary, issues=())
    document = JUnitXml.fromstring(render({"all": incomplete}, "junit").encode())
    assert document.errors == 1


@pytest.mark.parametrize("form", ["sarif", "github", "markdown"])
def test_messages_name_the_asset_of_several(form: str) -> None:
    reports = {name: scene_report(PENETRATING) for name in ("first", "second")}
    text = render(reports, form)
    for name in reports:
        assert f"{name}: block and block" in text
    assert "first: block and" not in render({"first": reports["first"]}, form)


def test_markdown_calls_an_unreadable_asset_an_error() -> None:
    assert "- **error** all: " in render({"all": MIXED}, "markdown")


def test_sarif_text_is_no_link() -> None:
    body = replace(BLOCK, id=r"[a](b)\c")
    result = json.loads(of_block(body, "sarif"))["runs"][0]["results"][0]
    assert result["message"]["text"].startswith(r"\[a\](b)\\c and ")


def test_markdown_shows_names_as_text() -> None:
    body = replace(BLOCK, id="<b>|`x`\n# y")
    text = render(
        {"all": report(replace(PENETRATING, a=body.id, b=body.id), bodies=(body,))}, "markdown"
    )
    assert "- **fail** all: " in text
    assert "\\<b\\>\\|\\`x\\` \\# y" in text


def rows_of(text: str) -> list[dict[str, str]]:
    """As a spreadsheet reads them."""
    plain = text.encode().decode("utf-8-sig")
    assert plain != text
    return list(csv.DictReader(io.StringIO(plain, newline="")))


def test_csv_has_the_worst_first() -> None:
    rows = rows_of(render({"all": MIXED}, "csv"))
    error = rows[0]
    assert (error["id"], error["severity"], error["reason"]) == (
        MISSING.code, "error", MISSING.message
    )  # fmt: skip
    assert [row["b"] for row in rows[1:3]] == ["deeper", "block_pushed"]
    assert [row["severity"] for row in rows[1:]] == ["error", "error", "warning", "note"]
    assert (rows[2]["depth"], rows[2]["mtv_x"], rows[2]["file_b"]) == (
        "1",
        "-1",
        "block_pushed.obj",
    )
    assert rows[-1]["depth"] == ""


def test_csv_has_separated_pairs_only_on_request() -> None:
    gap = replace(SEPARATED, b="far", distance=2.5)
    rows = rows_of(render({"all": scene_report(PENETRATING, SEPARATED, gap)}, "csv"))
    assert [row["b"] for row in rows if row["relation"] == "separated"] == ["far"]
    (alone,) = rows_of(render({"all": replace(scene_report(SEPARATED), issues=())}, "csv"))
    assert alone["relation"] == "separated"


def test_csv_has_units_rounded_figures_and_no_empty_column() -> None:
    third = 1 / 3
    finding = replace(PENETRATING, depth=third, depth_bounds=(third / 2, third), volume=2e7 / 3)
    whole = replace(scene_report(finding), units="millimeter", issues=())
    (row,) = rows_of(render({"all": whole}, "csv"))
    assert (row["depth [mm]"], row["depth_lower [mm]"]) == ("0.333333", "0.166667")
    assert row["volume [mm^3]"] == "6.66667e+06"
    assert all(value for name, value in row.items() if name != "undecided")
    assert {"asset", "units", "distance [mm]", "baseline", "undecided"}.isdisjoint(row)


def test_csv_of_assets_in_several_units_has_a_column_of_them() -> None:
    some = [replace(scene_report(PENETRATING), units=units) for units in ("mm", "meter")]
    rows = rows_of(render({"a.glb": some[0], "b.glb": some[1]}, "csv"))
    named = [(row["asset"], row["units"]) for row in rows if row["depth"]]
    assert named == [("b.glb", "m"), ("a.glb", "mm")]  # the larger overlap first


def test_csv_tells_when_and_where_moving_bodies_hit() -> None:
    assert HIT.motion is not None
    impact = replace(HIT.motion, point=(1.0, 2.0, 3.0), poses=(1, 2))
    hit = replace(HIT, b="far", motion=impact)
    rows = rows_of(render({"all": replace(scene_report(hit), units="mm")}, "csv"))
    row = rows[-1]
    assert (row["relation"], row["placed_relation"]) == ("penetrating", "separated")
    assert (row["impact_time"], row["impact_time_lower"]) == ("0.5", "0.25")
    assert [row[f"impact_{axis} [mm]"] for axis in "xyz"] == ["1", "2", "3"]
    assert (row["impact_pose_before"], row["impact_pose_after"]) == ("1", "2")


def test_csv_tells_what_a_baseline_accepts() -> None:
    states = ("unchanged", "new", "worse", "undecided", None)
    findings = [replace(PENETRATING, baseline_state=state) for state in states]
    rows = rows_of(render({"all": scene_report(*findings, TOUCH)}, "csv"))
    assert [(row["baseline"], row["severity"], row["fails"]) for row in rows[1:]] == [
        *((state, "error", "true") for state in ("new", "worse", "undecided", "")),
        ("unchanged", "note", "false"), ("", "note", "false"),
    ]  # fmt: skip
    assert rows[1]["mtv_verified"] == "true"


@pytest.mark.parametrize(
    "name", ["=1+1", "+1", "-1", "@SUM(A1)", " =1", "\N{FULLWIDTH EQUALS SIGN}1"]
)
def test_a_name_in_csv_is_no_formula(name: str) -> None:
    body = replace(BLOCK, id=name, file=f"{name}.obj")
    (row,) = rows_of(of_block(body, "csv"))
    assert (row["a"], row["file_a"]) == (f"'{name}", f"'{name}.obj")
    assert row["mtv_x"] == "-1"  # a number, which begins as it has to


def test_json_lines() -> None:
    head, *findings = [json.loads(line) for line in render({"all": MIXED}, "jsonl").splitlines()]
    assert (head["record"], head["schema"]) == ("report", "satcheck.report/1")
    assert [finding["id"] for finding in findings] == [finding.id for finding in MIXED.findings]


def test_a_file_outside_of_the_folder_has_a_file_uri(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert uri("parts/50% a.obj") == "parts/50%25%20a.obj"
    assert uri(str(tmp_path / "b.obj")) == "b.obj"
    assert uri("../b.obj") == f"file://{quote(str(tmp_path.parent / 'b.obj'))}"


@pytest.mark.parametrize("form", formats(("reports",)))
def test_the_name_of_the_file_chooses_the_format(form: str, tmp_path: Path) -> None:
    printed = satcheck("box.obj", "box_pushed.stl", "--format", form, cwd=SAMPLES)
    assert (printed.code, printed.err) == (1, "")
    for ending in formats()[form].endings:
        output = tmp_path / f"report{ending}"
        satcheck("box.obj", "box_pushed.stl", "-o", str(output), cwd=SAMPLES)
        assert output.read_bytes().decode() == printed.out


def test_only_a_report_has_these_formats() -> None:
    ran = satcheck("resolve", "box.obj", "box_pushed.stl", "-o", "x.sarif", cwd=SAMPLES)
    assert ran.code == 2
    assert ".scene.json, .txt, .json" in ran.err


SCENE = """\
schema = "satcheck.scene/1"

[[bodies]]
id = "grün"
shape = {type = "box", size = [2, 2, 2]}

[[bodies]]
id = "right"
shape = {type = "box", size = [2, 2, 2]}
position = [1, 0, 0]
"""
ROBOT = """\
<robot name="arm">
  <link name="base">
    <collision>
      <geometry><box size="1 1 1"/></geometry>
    </collision>
  </link>
  <link name="hand">
    <collision><geometry><box size="1 1 1"/></geometry></collision>
  </link>
  <joint name="j" type="fixed"><parent link="base"/><child link="hand"/></joint>
</robot>
"""


def places(sarif: str) -> list[tuple[str, int]]:
    """Of all locations of the only result."""
    (result,) = json.loads(sarif)["runs"][0]["results"]
    physical = [x["physicalLocation"] for x in result["locations"] + result["relatedLocations"]]
    return [(p["artifactLocation"]["uri"], p["region"]["startLine"]) for p in physical]


@pytest.mark.parametrize("command", [(), ("batch",)])
def test_a_result_is_where_a_scene_states_the_body(
    tmp_path: Path, command: tuple[str, ...]
) -> None:
    (tmp_path / "cell.toml").write_text(SCENE, encoding="utf-8")
    document = tomllib.loads(SCENE)
    (tmp_path / "cell.json").write_text(json.dumps(document, indent=0), encoding="utf-8")
    toml = satcheck(*command, "cell.toml", "--format", "sarif", cwd=tmp_path)
    assert places(toml.out) == [("cell.toml", 3), ("cell.toml", 7)]
    lines = (tmp_path / "cell.json").read_text("utf-8").splitlines()
    starts = [number for number, line in enumerate(lines, 1) if line == "{"][1:]
    as_json = satcheck(*command, "cell.json", "--format", "sarif", cwd=tmp_path)
    shapes = [line for line, text in enumerate(lines, 1) if '"shape"' in text]
    assert [file for file, _ in places(as_json.out)] == ["cell.json"] * 2
    for (_, line), before, shape in zip(
        places(as_json.out), (starts[0], shapes[0]), shapes, strict=True
    ):
        assert before <= line < shape
    annotated = satcheck(*command, "cell.toml", "--format", "github", cwd=tmp_path)
    assert annotated.out.startswith("::error file=cell.toml,line=3,")


def test_a_result_is_where_a_robot_states_the_body(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(ROBOT)
    ran = satcheck("arm.urdf", "--format", "sarif", "--fail-on", "error", cwd=tmp_path)
    results = json.loads(ran.out)["runs"][0]["results"]
    worst = results[0]["locations"] + results[0]["relatedLocations"]
    assert [x["physicalLocation"]["region"]["startLine"] for x in worst] == [3, 8]
    assert worst[0]["physicalLocation"]["artifactLocation"]["uri"] == "arm.urdf"


def test_a_wrong_scene_is_annotated_at_its_line(tmp_path: Path) -> None:
    (tmp_path / "cell.toml").write_text(SCENE.replace("position", "positon"), encoding="utf-8")
    ran = satcheck("batch", "cell.toml", "--format", "sarif", cwd=tmp_path)
    assert (ran.code, places(ran.out)) == (2, [("cell.toml", 10)])


def test_results_of_two_assets_have_fingerprints_of_their_own() -> None:
    run = json.loads(render({"a.glb": MIXED, "b.glb": MIXED}, "sarif"))["runs"][0]
    prints = [result["partialFingerprints"]["satcheckId/v1"] for result in run["results"]]
    assert len(set(prints)) == len(prints) == 12


def test_a_body_that_is_not_supported_fails_its_test_case(tmp_path: Path) -> None:
    """The cube stands, the other hangs in the air beside it: no pair fails."""
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'schema = "satcheck.scene/1"\nunits = "m"\n'
        '[[bodies]]\nid = "floor"\nshape = { type = "box", size = [4, 4, 1] }\nstatic = true\n'
        '[[bodies]]\nid = "cube"\nshape = { type = "box", size = [1, 1, 1] }\n'
        "position = [0, 0, 1]\n"
        '[[bodies]]\nid = "lamp"\nshape = { type = "box", size = [1, 1, 1] }\n'
        "position = [0, 0, 5]\n"
        '[[rules]]\nbodies = "*"\nsupported = true\n'
    )
    ran = satcheck(str(scene), "--format", "junit")
    assert ran.code == 1
    (suite,) = JUnitXml.fromstring(ran.out.encode())
    failed = {case.name: case.result[0] for case in suite if case.result}
    assert list(failed) == ["lamp is supported"]
    assert isinstance(failed["lamp is supported"], Failure)
    assert "it floats" in failed["lamp is supported"].message
    assert "cube is supported" in [case.name for case in suite]


def test_a_body_that_leaves_its_region_fails_in_every_format(tmp_path: Path) -> None:
    """One body and its room: there is no pair to check, and an answer all the same."""
    scene = tmp_path / "scene.toml"
    text = (
        'schema = "satcheck.scene/1"\nunits = "m"\n'
        '[[bodies]]\nid = "room"\nshape = { type = "box", size = [4, 4, 4] }\n'
        '[[bodies]]\nid = "lamp"\nshape = { type = "box", size = [1, 1, 1] }\n'
        "position = [0, 0, 1.75]\n"
        '[[rules]]\nbodies = "room"\nregion = true\n'
        '[[rules]]\nbodies = "*"\ninside = "room"\n'
    )
    scene.write_text(text)
    table = satcheck(str(scene), "--explain")
    assert table.code == 1
    assert "lamp: not inside: it sticks out by 0.25" in table.out
    assert "FAIL: lamp is not inside room" in table.out
    (suite,) = JUnitXml.fromstring(satcheck(str(scene), "--format", "junit").out.encode())
    assert [case.name for case in suite if case.result] == ["lamp is inside room"]
    for form in ("sarif", "github", "markdown"):
        assert "lamp is not inside room" in satcheck(str(scene), "--format", form).out
    assert satcheck(str(scene), "--format", "github").out.startswith("::error ")
    scene.write_text(text + 'severity = "warning"\n')
    assert satcheck(str(scene), "--format", "github").out.startswith("::warning ")
    scene.write_text(text.replace("1.75", "1.5"))
    passed = satcheck(str(scene))
    assert (passed.code, "1 body inside the region" in passed.out) == (0, True)


@pytest.mark.parametrize(
    "form", ["table", "csv", "json", "jsonl", "github", "junit", "sarif", "markdown"]
)
def test_every_format_tells_what_was_not_read(form: str, tmp_path: Path) -> None:
    (tmp_path / "box.obj").write_bytes((SAMPLES / "box.obj").read_bytes())
    (tmp_path / "hull.fbx").write_text("not a mesh for us")
    ran = satcheck("batch", str(tmp_path), "--format", form)
    assert (ran.code, "hull.fbx" in ran.out) == (3, True)


def test_csv_has_a_row_for_what_lets_nothing_pass(tmp_path: Path) -> None:
    """Also if nothing but the summary tells of it, and for the answer about a single body."""
    summary = replace(report(SEPARATED).summary, verdict="incomplete")
    silent = replace(scene_report(SEPARATED), summary=summary, issues=())
    (first, _) = rows_of(render({"all": silent}, "csv"))
    assert first["reason"].startswith(silent.message)
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'schema = "satcheck.scene/1"\nunits = "m"\n'
        '[[bodies]]\nid = "room"\nshape = { type = "box", size = [4, 4, 4] }\n'
        '[[bodies]]\nid = "lamp"\nshape = { type = "box", size = [1, 1, 1] }\n'
        "position = [0, 0, 1.75]\n"
        '[[rules]]\nbodies = "room"\nregion = true\n[[rules]]\nbodies = "*"\ninside = "room"\n'
    )
    (row,) = rows_of(satcheck(str(scene), "--format", "csv").out)
    assert (row["a"], row["fails"], row["severity"]) == ("lamp", "true", "error")


@pytest.mark.parametrize("form", ["table", "github", "junit", "sarif", "markdown"])
def test_every_format_prints_the_same_message(form: str) -> None:
    said = satcheck(*PUSHED, "--format", form).out.replace("\\", "")
    assert "box and box_pushed overlap (thickness 1, 1 to pull apart)" in said
