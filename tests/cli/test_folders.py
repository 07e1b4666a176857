"""`satcheck batch`: the assets of a folder, each a scene of its own."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from junitparser import JUnitXml

from satcheck.cli.commands.schema import text
from satcheck.cli.formats.registry import formats
from tests.audit.batch.test_slot import PLANTED
from tests.cli.process import SAMPLES, command, environment, on_posix, satcheck
from tests.plugin_marks import needs

SCHEMA = Draft202012Validator(json.loads(text("assets")))


@pytest.fixture
def assets(tmp_path: Path) -> Path:
    """A folder with a scene that fails, a mesh, a JSON file of another kind, and a hidden mesh."""
    folder = tmp_path / "assets"
    (folder / "props").mkdir(parents=True)
    (folder / ".cache").mkdir()
    shutil.copy(SAMPLES / "gripper.glb", folder)
    shutil.copy(SAMPLES / "box.obj", folder / "props")
    shutil.copy(SAMPLES / "box.obj", folder / ".cache")
    (folder / "package.json").write_text("{}")
    return folder


def verdicts(ran_out: str) -> dict[str, str]:
    document = json.loads(ran_out)
    SCHEMA.validate(document)
    return {Path(asset["file"]).name: asset["verdict"] for asset in document["assets"]}


def test_each_asset_of_a_folder_is_its_own_scene(assets: Path) -> None:
    ran = satcheck("batch", str(assets), "--format", "json")
    assert ran.code == 1
    assert verdicts(ran.out) == {"gripper.glb": "fail", "box.obj": "pass"}


def test_warnings_about_assets_that_pass_are_counted(assets: Path) -> None:
    for name in ("open_box.off", "inside_out.stl"):
        shutil.copy(SAMPLES / name, assets)
    ran = satcheck("batch", ".", cwd=assets, env={"COLUMNS": "400"})
    said = "Warnings about 2 passing assets (inside_out.stl, open_box.off): 1 turned mesh, 1 open"
    assert said in ran.out
    (assets / "open_box.off").unlink()
    (assets / "inside_out.stl").unlink()
    assert "Warnings" not in satcheck("batch", ".", cwd=assets).out


def test_an_unreadable_asset_leaves_the_others_their_answers(assets: Path) -> None:
    (assets / "broken.obj").write_text("f 1 2 3\n")
    (assets / "wrong.toml").write_text('format = "satcheck.scene/1"\nnonsense = 1\n')
    ran = satcheck("batch", str(assets), "--format", "json")
    assert ran.code == 2
    assert verdicts(ran.out) == {
        "gripper.glb": "fail", "box.obj": "pass", "broken.obj": "error", "wrong.toml": "error"
    }  # fmt: skip


def test_patterns_and_names_from_standard_input(assets: Path) -> None:
    pattern = satcheck("batch", f"{assets}/**/*.obj", "--format", "json")
    assert verdicts(pattern.out) == {"box.obj": "pass"}
    named = satcheck("batch", "-", "--format", "json", stdin=f"{assets}/gripper.glb\n")
    assert verdicts(named.out) == {"gripper.glb": "fail"}


@pytest.fixture
def foreign(assets: Path) -> Path:
    """A folder with a mesh, with files that no reader knows, and with others that are no meshes."""
    folder = assets / "props"
    (folder / "source").mkdir()
    for name in ("chair.FBX", "source/a b.blend", "paint.png", "notes.txt"):
        (folder / name).touch()
    return folder


def test_files_that_no_reader_knows_block_a_pass(foreign: Path) -> None:
    names = ["chair.FBX", "source/a b.blend"]
    ran = satcheck("batch", "props", "--format", "json", cwd=foreign.parent)
    assert (ran.code, verdicts(ran.out)) == (3, {"box.obj": "pass", "props": "incomplete"})
    (asset,) = (each for each in json.loads(ran.out)["assets"] if each["file"] == "props")
    issues = [issue for issue in asset["report"]["issues"] if issue["code"] == "unread-file"]
    assert [issue["file"] for issue in issues] == [f"props/{name}" for name in names]
    assert {issue["state"] for issue in issues} == {"blocking"}
    line = "satcheck: props: no reader knows 2 files: props/chair.FBX, props/source/a b.blend\n"
    assert line in ran.err
    assert "chair" not in satcheck("batch", "props", "-q", cwd=foreign.parent).err


def test_such_files_stand_in_every_format(foreign: Path) -> None:
    table = satcheck("batch", str(foreign), env={"COLUMNS": "400"})
    assert "props/chair.FBX: files of FBX are not read" in " ".join(table.out.split())
    assert "Next:" not in table.out
    suites = JUnitXml.fromstring(satcheck("batch", str(foreign), "--format", "junit").out.encode())
    assert sum(suite.errors for suite in suites) == 2
    assert "chair.FBX" in satcheck("batch", str(foreign), "--format", "github").out
    into = ("batch", "props", "-o", "results.jsonl")
    assert satcheck(*into, cwd=foreign.parent).code == 3
    assert satcheck(*into, "--resume", cwd=foreign.parent).code == 3
    ran = satcheck("view", "results.jsonl", "--format", "table", cwd=foreign.parent)
    assert "1 incomplete (props)" in ran.out


@pytest.mark.parametrize(
    ("options", "code"),
    [
        (("--accept", "unread-file"), 0),
        (("--accept", "unread-file:chair.FBX", "--accept", "unread-file:a b.blend"), 0),
        (("--accept", "unread-file:chair.FBX"), 3),
        (("--accept", "unread"), 3),
        (("--exclude", "*.FBX", "--exclude", "source"), 0),
        (("--exclude", "source/*", "--exclude", "chair.FBX"), 0),
        (("--exclude", "*.FBX"), 3),
    ],
)
def test_such_files_are_accepted_or_excluded(
    options: tuple[str, ...], code: int, foreign: Path
) -> None:
    assert satcheck("batch", str(foreign), *options).code == code
    results = str(foreign.parent / "results.jsonl")
    assert satcheck("batch", str(foreign), "-o", results, *options).code == code


def test_without_exclude_a_hint_says_how_to_leave_a_file_out(foreign: Path) -> None:
    ran = satcheck("batch", "props", "--format", "json", cwd=foreign.parent)
    assert "--exclude chair.FBX, or --accept unread-file:chair.FBX" in ran.out
    assert "--exclude 'a b.blend', or --accept 'unread-file:a b.blend'" in ran.out
    assert "--exclude leaves out" not in ran.err
    (foreign / "box.obj").unlink()
    nothing = satcheck("batch", "props", cwd=foreign.parent)
    assert (nothing.code, "but 2 that no reader knows, as" in nothing.err) == (2, True)
    assert "--exclude leaves out" not in nothing.err


def test_what_is_excluded_is_counted(foreign: Path) -> None:
    ran = satcheck("batch", str(foreign), "--exclude", "source", "--exclude", "chair.*")
    assert "satcheck: --exclude leaves out 2 files\n" in ran.err
    (foreign / "satcheck.toml").write_text('exclude = ["source", "chair.*"]\n')
    found = satcheck("batch", ".", cwd=foreign)
    assert (found.code, "satcheck.toml sets exclude" in found.err) == (0, True)
    named = satcheck("batch", str(foreign / "box.obj"), "--exclude", "box.obj")
    assert named.code == 0
    nothing = satcheck("batch", str(foreign), "--exclude", "box.obj")
    assert nothing.code == 2
    assert "but 2 that no reader knows" in nothing.err


def test_a_file_that_no_reader_knows_is_an_error_where_it_is_named(foreign: Path) -> None:
    ran = satcheck("batch", str(foreign / "chair.FBX"), "--format", "json")
    assert (ran.code, verdicts(ran.out)) == (2, {"chair.FBX": "error"})


@needs("usd")
def test_a_file_of_materials_is_no_fault_among_assets(assets: Path) -> None:
    pytest.importorskip("pxr")
    head = '#usda 1.0\n(\n metersPerUnit = 1\n upAxis = "Z"\n)\n'
    paint = assets / "props" / "paint.usda"
    paint.write_text(f'{head}def Material "Paint" {{}}\n')
    ran = satcheck("batch", str(assets / "props"), "--format", "json")
    assert (ran.code, verdicts(ran.out)) == (0, {"box.obj": "pass", "paint.usda": "pass"})
    (asset,) = (each for each in json.loads(ran.out)["assets"] if "paint" in each["file"])
    stated = {issue["code"]: issue["severity"] for issue in asset["report"]["issues"]}
    assert stated["no-body"] == "note"
    assert satcheck(str(paint), str(assets / "props" / "box.obj")).code == 2
    scene = f'schema = "satcheck.scene/1"\n[[bodies]]\nid = "a"\nmesh = "{paint.name}"\n'
    (assets / "props" / "s.toml").write_text(scene)
    ran = satcheck("batch", str(assets / "props"), "--format", "json")
    assert verdicts(ran.out)["s.toml"] == "error"
    paint.write_text(f'{head}def Mterial "Paint" {{ double radius = 1 }}\n')
    ran = satcheck("batch", str(assets / "props"), "--format", "json")
    assert verdicts(ran.out)["paint.usda"] == "error"


@pytest.mark.parametrize("given", ["kit", "kit/**/*.toml", "-"])
def test_assets_may_name_what_lies_in_the_folder_that_is_given(given: str, tmp_path: Path) -> None:
    (tmp_path / "kit" / "sets").mkdir(parents=True)
    shutil.copy(SAMPLES / "box.obj", tmp_path / "kit")
    body = '[[bodies]]\nid = "a"\nmesh = "../box.obj"\n'
    (tmp_path / "kit" / "sets" / "s.toml").write_text(f'schema = "satcheck.scene/1"\n{body}')
    ran = satcheck("batch", given, "--format", "json", stdin="kit\n", cwd=tmp_path)
    assert verdicts(ran.out)["s.toml"] == "pass"
    alone = satcheck("batch", "kit/sets/s.toml", "--format", "json", cwd=tmp_path)
    assert verdicts(alone.out) == {"s.toml": "error"}
    batch = satcheck("batch", given, "-o", "out.jsonl", stdin="kit\n", cwd=tmp_path)
    assert batch.code == 0


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("empty", "no mesh, scene or robot"),
        ("*.glb", "*.glb: the pattern matches no file here: **/*.glb searches sub-folders too"),
        ("empty/**/*.glb", "empty/**/*.glb: the pattern matches no file here [no-assets]"),
    ],
)
def test_nothing_to_check_is_an_error(name: str, told: str, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    ran = satcheck("batch", name, cwd=tmp_path)
    assert ran.code == 2
    assert told in ran.err


def test_a_missing_folder_is_an_error_and_no_body(tmp_path: Path) -> None:
    ran = satcheck("batch", "nowhere", cwd=tmp_path)
    assert ran.code == 2
    assert ran.out.endswith("ERROR: 1 asset: 1 has errors (nowhere).\n")
    (row,) = (line.split() for line in ran.out.splitlines() if "no such file" in line)
    assert row[:2] == ["nowhere", "error"]
    assert ran.err == ""


def test_junit_has_a_suite_for_each_asset(assets: Path) -> None:
    document = JUnitXml.fromstring(satcheck("batch", str(assets), "--format", "junit").out.encode())
    suites = {Path(suite.name).name: (suite.tests, suite.failures) for suite in document}
    assert suites == {"gripper.glb": (6, 1), "box.obj": (1, 0)}


def test_the_table_ends_with_the_verdict(assets: Path) -> None:
    ran = satcheck("batch", str(assets), env={"COLUMNS": "400"})
    counts, last, rules = ran.out.splitlines()[-3:]
    (failing,) = re.findall(r"satcheck (\S+) lists", last)
    assert re.fullmatch(r"FAIL: 2 assets: 1 fails( \(\S+\))?, 1 passes \(of one .*\)\.", counts)
    assert last == f"Next: satcheck {failing} lists its pairs."
    assert satcheck(failing).code == 1
    line = rules.removeprefix("Next: ").removesuffix(" proposes rules for overlaps that are meant.")
    assert line == shlex.join(["satcheck", "suggest", str(assets), "-o", "rules.toml"])


def kit_of_three(folder: Path) -> None:
    """Overlaps of 1 mm, 0.25 m and 2 mm; the names are in no order of these."""
    (folder / "kit").mkdir()
    plate = 'id = "plate", shape = {type = "box", size = [10, 10, 2]}'
    for name, units, depth in (("a", "mm", 1), ("b", "m", 0.25), ("c", "mm", 2)):
        bolt = 'id = "bolt", shape = {type = "box", size = [2, 2, 3]}, position = '
        bodies = f"bodies = [{{{plate}}}, {{{bolt}[0, 0, {2.5 - depth}]}}]"
        text = f'schema = "satcheck.scene/1"\nunits = "{units}"\n{bodies}\n'
        (folder / "kit" / f"{name}.toml").write_text(text)


def test_the_worst_asset_is_named_first(tmp_path: Path) -> None:
    kit_of_three(tmp_path)
    ran = satcheck("batch", "kit", cwd=tmp_path)
    assert "FAIL: 3 assets: 3 fail (kit/b.toml, kit/c.toml, kit/a.toml).\n" in ran.out
    assert "\nNext: satcheck kit/b.toml lists its pairs.\n" in ran.out


def test_results_alone_name_the_worst_assets(tmp_path: Path) -> None:
    kit_of_three(tmp_path)
    ran = satcheck("batch", "kit", "-o", "r.jsonl", cwd=tmp_path)
    assert (ran.code, ran.out) == (1, "")
    named = "FAIL: 3 assets: 3 fail (kit/b.toml, kit/c.toml, kit/a.toml). Results: r.jsonl\n"
    assert ran.err.startswith(named)


def test_three_commands_that_the_screen_names_make_a_gate(tmp_path: Path) -> None:
    (tmp_path / "my props").mkdir()
    shutil.copy(SAMPLES / "gripper.glb", tmp_path / "my props")
    (tmp_path / "my props/broken.glb").write_bytes(b"glTF")
    first = satcheck("batch", "my props", "--units", "m", cwd=tmp_path, env={"COLUMNS": "400"})
    assert first.code == 2
    words = "--exclude broken.glb leaves out my props/broken.glb until it is mended."
    assert first.out.endswith(f"\nNext: {words}\n")
    (line,) = re.findall(r"Next: satcheck (suggest .*) proposes", first.out)
    second = satcheck(*shlex.split(line), cwd=tmp_path)
    (line,) = re.findall(r"Next: satcheck (.*) checks with these rules", second.err)
    assert line == "batch 'my props' --units m --rules rules.toml"
    third = satcheck(*shlex.split(line), "--exclude", "broken.glb", cwd=tmp_path)
    assert (third.code, "PASS: 1 asset" in third.out) == (0, True)


def test_a_misspelt_folder_is_told_with_the_one_that_is_there(tmp_path: Path) -> None:
    (tmp_path / "props").mkdir()
    ran = satcheck("batch", "prop", cwd=tmp_path)
    assert (ran.code, "no such file or folder (did you mean 'props'?)" in ran.out) == (2, True)


def git(folder: Path, *arguments: str) -> None:
    identity = ("-c", "user.name=a", "-c", "user.email=a@b.c")
    subprocess.run(("git", *identity, *arguments), cwd=folder, check=True, capture_output=True)


def test_changed_since_a_revision(assets: Path) -> None:
    """A scene has changed when a mesh that it names has."""
    shutil.copy(SAMPLES / "ring.glb", assets / "ring.glb")
    (assets / "scene.toml").write_text(
        'schema = "satcheck.scene/1"\n'
        + "".join(
            f'[[bodies]]\nid = "{name}"\nmesh = "props/box.obj"\nposition = [{x}, 0, 0]\n'
            for name, x in (("a", 0), ("b", 10))
        )
    )
    git(assets, "init", "-q")
    git(assets, "add", ".")
    git(assets, "commit", "-q", "-m", "first")
    arguments = ("batch", str(assets), "--changed-since", "HEAD", "--format", "json")
    unchanged = satcheck(*arguments)
    assert (unchanged.code, verdicts(unchanged.out)) == (0, {})
    assert satcheck(*arguments[:-2]).out == ""
    with (assets / "props" / "box.obj").open("a") as file:
        file.write("# changed\n")
    shutil.copy(SAMPLES / "cube.off", assets / "new.off")
    assert verdicts(satcheck(*arguments).out) == {
        "box.obj": "pass", "new.off": "pass", "scene.toml": "pass"
    }  # fmt: skip


@pytest.mark.parametrize("form", formats(("reports",)))
def test_without_a_changed_asset_there_is_a_document(form: str, assets: Path) -> None:
    git(assets, "init", "-q")
    git(assets, "add", ".")
    git(assets, "commit", "-q", "-m", "first")
    output = assets / ".report"
    ran = satcheck(
        "batch", str(assets), "--changed-since", "HEAD", "--format", form, "-o", str(output)
    )
    assert ran.code == 0
    text = output.read_text()
    if form == "sarif":
        assert json.loads(text)["runs"][0]["results"] == []
    if form == "junit":
        assert JUnitXml.fromstring(text.encode()).tests == 0


def test_an_unknown_revision_is_an_error(assets: Path) -> None:
    git(assets, "init", "-q")
    ran = satcheck("batch", str(assets), "--changed-since", "nowhere")
    assert ran.code == 2
    assert "no revision nowhere: give a branch" in ran.err


def test_an_output_never_replaces_an_asset(assets: Path) -> None:
    mesh = assets / "props" / "box.obj"
    before = mesh.read_bytes()
    ran = satcheck("batch", str(assets), "--format", "json", "-o", str(mesh))
    assert ran.code == 2
    assert "would overwrite an input" in ran.err
    assert mesh.read_bytes() == before


def test_errors_and_the_summary_go_to_stderr(assets: Path) -> None:
    (assets / "broken.obj").write_text("f 1 2 3\n")
    quiet = satcheck("batch", "-q", str(assets))
    assert quiet.out == ""
    assert "satcheck: error: " in quiet.err
    assert "broken.obj" in quiet.err
    output = assets / "report.json"
    told = satcheck("batch", str(assets), "-o", str(output)).err
    assert told.splitlines()[-1].endswith(f"Report: {output}")


def test_a_pattern_with_two_stars_in_a_name_is_refused(assets: Path) -> None:
    ran = satcheck("batch", "props/**.obj", cwd=assets)
    assert ran.code == 2
    assert "write props/**/*.obj" in ran.err
    assert satcheck("batch", "props/**/*.obj", cwd=assets).code == 0


@on_posix
def test_a_pipe_is_not_read(assets: Path) -> None:
    os.mkfifo(assets / "pipe.json")
    ran = satcheck("batch", str(assets), "--format", "json")
    assert verdicts(ran.out)["pipe.json"] == "error"


@on_posix
@pytest.mark.skipif(os.name == "posix" and os.geteuid() == 0, reason="root lists any folder")
def test_a_folder_that_cannot_be_listed_is_an_error(assets: Path) -> None:
    (assets / "props").chmod(0)
    ran = satcheck("batch", str(assets))
    (assets / "props").chmod(0o700)
    assert ran.code == 2
    assert "props: the folder cannot be listed: " in ran.err


def test_a_length_without_known_units_is_an_error_of_the_asset(assets: Path) -> None:
    bodies = [f'[[bodies]]\nid = "{name}"\nmesh = "props/box.obj"\n' for name in "ab"]
    (assets / "pair.toml").write_text("".join(['schema = "satcheck.scene/1"\n', *bodies]))
    ran = satcheck("batch", str(assets), "--clearance", "1mm", "--format", "json")
    document = json.loads(ran.out)
    issues = {Path(each["file"]).name: each["report"]["issues"] for each in document["assets"]}
    assert [issue["code"] for issue in issues["pair.toml"]] == ["bad-setting"]
    assert "--units" in issues["pair.toml"][0]["message"]
    table = satcheck("batch", str(assets), "--clearance", "1mm").out
    assert "\nNext: --units states the unit of files that have none.\n" in table
    assert "--exclude pair.toml" not in table
    assert issues["box.obj"] == []  # a body alone has no pair that the length is about


@on_posix
def test_a_closed_standard_input_is_wrong_usage() -> None:
    line = shlex.join(command("batch", "-")) + " <&-"
    ran = subprocess.run(
        line, shell=True, capture_output=True, text=True, env=environment(), check=False
    )
    assert ran.returncode == 2
    assert "standard input is closed" in ran.stderr


def test_names_may_end_with_nul(assets: Path) -> None:
    odd = assets / "a\u2028b.obj"
    shutil.copy(SAMPLES / "box.obj", odd)
    for end in ("\0", "\n"):
        ran = satcheck("batch", "-", "--format", "json", stdin=f"{odd}{end}")
        assert verdicts(ran.out) == {odd.name: "pass"}


def test_a_page_is_a_gallery_of_the_worst_of_each_asset(tmp_path: Path) -> None:
    """A rack has many findings, and a gripper one: each has one picture."""
    for name in ("rack.3mf", "gripper.glb", "box.obj"):
        shutil.copy(SAMPLES / name, tmp_path)
    ran = satcheck("batch", ".", "-o", "all.html", "-o", "all.csv", cwd=tmp_path)
    assert ran.code == 1
    page = (tmp_path / "all.html").read_text()
    assert page.count("data:image/png") == 2
    assert "rack.3mf" in (tmp_path / "all.csv").read_text()
    satcheck("batch", ".", "-o", "all.jsonl", "-o", "beside.html", cwd=tmp_path)
    assert (tmp_path / "beside.html").read_text().count("data:image/png") == 2


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--resume",), "--resume: name a file for the results"),
        (("-o", "all.json", "--resume"), "--resume: name a file for the results"),
        (("--format", "results"), "results go to one file"),
        (("-o", "a.jsonl", "-o", "b.jsonl"), "results go to one file"),
        (("-o", "all.png"), "this command writes .txt, .json"),
        (("--read", "chord-tolerance=1"), "no reader of these files has this option"),
    ],
)
def test_what_makes_no_sense_of_many_assets(
    tmp_path: Path, words: tuple[str, ...], told: str
) -> None:
    shutil.copy(SAMPLES / "box.obj", tmp_path)
    ran = satcheck("batch", ".", *words, cwd=tmp_path)
    assert (ran.code, ran.out) == (2, "")
    assert told in " ".join(ran.err.split())


def test_what_is_not_checked_never_passes(tmp_path: Path) -> None:
    """A finding is forgiven, and an open asset beside it is not."""
    for name in ("rack.3mf", "box.obj"):
        shutil.copy(SAMPLES / name, tmp_path)
    (tmp_path / "chair.fbx").write_bytes(b"Kaydara FBX Binary")
    ran = satcheck("batch", ".", "--exit-zero", "-o", "all.json", "-o", "all.txt", cwd=tmp_path)
    assert ran.code == 3
    assert satcheck("batch", ".", "-o", "all.jsonl", "--exit-zero", cwd=tmp_path).code == 3
    assert satcheck("view", "all.json", "--exit-zero", "--format", "csv", cwd=tmp_path).code == 3


def test_an_open_pair_counts_beside_one_that_fails_in_the_same_asset(tmp_path: Path) -> None:
    """As in a plain check of this asset."""
    for name in ("open_box.off", "cube.off", "box.obj", "box_pushed.stl"):
        shutil.copy(SAMPLES / name, tmp_path)
    body = '[[bodies]]\nid = "{0}"\nmesh = "{1}"\nposition = [{2}, 0, {3}]\n'
    failing = [body.format("a", "box.obj", 30, 0), body.format("b", "box_pushed.stl", 30, 0)]
    open_too = [
        *failing,
        body.format("c", "open_box.off", 0, 0),
        body.format("d", "cube.off", 0, 2),
    ]
    for name, bodies in (("fails", failing), ("open", open_too)):
        text = "".join(['schema = "satcheck.scene/1"\n', *bodies])
        (tmp_path / f"{name}.toml").write_text(text)
    codes = {}
    for name in ("fails", "open"):
        scene, results = f"{name}.toml", f"{name}.jsonl"
        calls = [(scene,), ("batch", scene), ("batch", scene, "-o", results)]
        calls += [("batch", scene, "-o", f"{name}2.jsonl", "-o", f"{name}.csv")]
        calls += [("view", results, "--format", "csv")]
        codes[name] = [satcheck(*call, "--exit-zero", cwd=tmp_path).code for call in calls]
    assert codes == {"fails": [0] * 5, "open": [3] * 5}


def test_without_a_place_for_results_the_run_says_so(assets: Path) -> None:
    lost = f"import sys, tempfile; tempfile.tempdir = {str(assets / 'gone')!r}"
    call = f"{lost}; sys.argv = ['satcheck', 'batch', '.']; from satcheck.cli import main; main()"
    ran = subprocess.run(
        [sys.executable, "-c", call],
        cwd=assets,
        env=environment(),
        capture_output=True,
        check=False,
    )
    assert (ran.returncode, ran.stdout) == (2, b"")
    assert b"error: a temporary file: cannot write: No such file" in ran.stderr


@on_posix
def test_a_full_place_for_results_says_what_to_do(assets: Path) -> None:
    """A limit of the size of files stands for it, as in test_batch_ends."""
    import resource

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (500, resource.RLIM_INFINITY))

    ran = subprocess.run(
        command("batch", "."),
        cwd=assets,
        env=environment({"PYTHONDONTWRITEBYTECODE": "1"}),
        preexec_fn=limit,
        capture_output=True,
        check=False,
    )
    assert (ran.returncode, ran.stdout) == (2, b"")
    assert b"results.jsonl: cannot be written" in ran.stderr
    assert b"name another folder in TMPDIR, or a file for the results" in ran.stderr


def test_a_folder_of_accepted_files_is_no_asset(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "rack.3mf", tmp_path)
    for name in ("chair.fbx", "table.blend"):
        (tmp_path / name).write_bytes(b"no mesh")
    ran = satcheck("batch", ".", "--accept", "unread-file", "--max-depth", "1mm", cwd=tmp_path)
    assert (ran.code, ran.out) == (0, "PASS: 1 asset: 1 passes, 2 issues accepted.\n")


@pytest.mark.parametrize("content", [b"", b"\n \r\n", b"\0" * 512])
def test_a_scene_whose_content_is_lost_is_an_error(assets: Path, content: bytes) -> None:
    for name in ("level.toml", "level.json"):
        (assets / name).write_bytes(content)
    ran = satcheck("batch", ".", "--format", "json", cwd=assets)
    lost = {"level.toml": "error", "level.json": "error"}
    assert verdicts(ran.out) == {"gripper.glb": "fail", "box.obj": "pass", **lost}


RULES = '[[rules]]\na = "box"\nb = "box_pushed"\nallowed = true\nreason = "a press fit"\n'


def test_a_file_of_rules_is_no_asset(assets: Path) -> None:
    header = 'schema = "satcheck.scene/1"\nbodies = []\n'
    (assets / "allowed.toml").write_text(header + RULES)
    (assets / "nothing.toml").write_text(header + "rules = []\n")  # as suggest writes it
    (assets / "empty.toml").write_text(header)
    ran = satcheck("batch", ".", "--format", "json", cwd=assets)
    assert verdicts(ran.out) == {"gripper.glb": "fail", "box.obj": "pass", "empty.toml": "error"}
    for name in ("allowed.toml", "nothing.toml"):
        assert f"{name} has only rules and is no asset: --rules {name}" in ran.err
    alone = satcheck("batch", "allowed.toml", cwd=assets)
    assert (alone.code, "no file is named" in alone.err) == (2, True)


def overlapping(folder: Path) -> Path:
    """A scene of box and box_pushed, which overlap."""
    for name in ("box.obj", "box_pushed.stl"):
        shutil.copy(SAMPLES / name, folder)
    bodies = "".join(
        f'[[bodies]]\nid = "{Path(name).stem}"\nmesh = "{name}"\n'
        for name in ("box.obj", "box_pushed.stl")
    )
    scene = folder / "fit.toml"
    scene.write_text(f'schema = "satcheck.scene/1"\n{bodies}')
    (folder / "allowed.toml").write_text(RULES)
    return scene


@pytest.mark.parametrize("baseline", [(), ("--baseline", "known.json")])
def test_an_asset_whose_pairs_are_all_allowed_passes_and_says_so(
    baseline: tuple[str, ...], tmp_path: Path
) -> None:
    overlapping(tmp_path)
    (tmp_path / "known.json").write_text('{"schema": "satcheck.baseline/1"}')
    call = ("batch", "fit.toml", "--rules", "allowed.toml", *baseline)
    assert satcheck("batch", "fit.toml", cwd=tmp_path).code == 1
    ran = satcheck(*call, cwd=tmp_path)
    assert ran.code == 0
    assert ran.out.startswith("PASS: 1 asset: 1 passes.\nNo pair of 1 passing asset was checked: ")
    suites = satcheck(*call, "--format", "junit", cwd=tmp_path).out
    assert "PASS: no pair was checked: 1 allowed by rules." in suites


@pytest.mark.parametrize(
    "line", ["check_static = false", 'ignore_within_groups = ["all"]'], ids=["static", "group"]
)
def test_an_asset_that_exempts_its_pairs_in_another_way_is_incomplete(
    line: str, tmp_path: Path
) -> None:
    scene = overlapping(tmp_path)
    marked = scene.read_text().replace('.obj"', '.obj"\nstatic = true\ngroups = ["all"]')
    marked = marked.replace('.stl"', '.stl"\nstatic = true\ngroups = ["all"]')
    scene.write_text(marked.replace("[[bodies]]", f"{line}\n[[bodies]]", 1))
    ran = satcheck("batch", "fit.toml", "--rules", "allowed.toml", cwd=tmp_path)
    assert ran.code == 3
    assert "no pair was checked: 1 " in ran.out


def test_the_reason_of_an_incomplete_asset_comes_first(tmp_path: Path) -> None:
    """Not the warning about the hole of a body."""
    for name in ("open_box.off", "cube.off"):
        shutil.copy(SAMPLES / name, tmp_path)
    bodies = "".join(
        f'[[bodies]]\nid = "{name}"\nmesh = "{name}.off"\nstatic = true\n'
        for name in ("open_box", "cube")
    )
    header = 'schema = "satcheck.scene/1"\ncheck_static = false\n'
    (tmp_path / "fit.toml").write_text(header + bodies)
    ran = satcheck("batch", "fit.toml", cwd=tmp_path)
    assert ran.code == 3
    assert "  no pair was checked: 1 of static bodies\n" in ran.out


def test_the_proposed_check_has_the_options_that_change_its_answer(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "gripper.glb", tmp_path / "a b.glb")
    (tmp_path / "allowed.toml").write_text(RULES)
    options = ("--no-depth", "--rules=allowed.toml", "--clearance", "2mm", "--top", "3")
    ran = satcheck("batch", ".", *options, cwd=tmp_path)
    (line,) = re.findall(r"Next: satcheck (.*) lists its pairs", ran.out)
    words = shlex.split(line)
    assert words == ["a b.glb", "--no-depth", "--rules", "allowed.toml", "--clearance", "2mm"]
    assert satcheck(*words, cwd=tmp_path).code == 1


@needs("step")
def test_the_proposed_check_leaves_out_what_it_would_refuse(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "gripper.glb", tmp_path)
    scene = 'schema = "satcheck.scene/1"\n[[bodies]]\nid = "a"\nmesh = "gripper.glb"\n'
    (tmp_path / "s.toml").write_text(scene)  # it may place a STEP file
    options = ("--limit", "scene-seconds=99,scene-megabytes=3000", "--read", "chord-tolerance=1")
    ran = satcheck("batch", ".", *options, cwd=tmp_path)
    assert "\nNext: satcheck gripper.glb lists its pairs.\n" in ran.out


@on_posix
@pytest.mark.parametrize(
    ("word", "code", "how"),
    [
        ("segfault", "worker-crashed", "died (SIGSEGV)"),
        ("hang", "worker-timeout", "was stopped after 3 s"),
        ("bomb", "worker-out-of-memory", "needed more than 1024 MiB"),
    ],
)
def test_a_native_fault_takes_no_other_asset_down(
    tmp_path: Path, word: str, code: str, how: str
) -> None:
    names = ("a.obj", f"{word}.obj", "z.obj")
    for name in names:
        shutil.copy(SAMPLES / "box.obj", tmp_path / name)
    limits = ("--limit", "scene-seconds=3,scene-megabytes=1024")
    options = ("-j", "1", "--format", "json", *limits)
    ran = satcheck("batch", ".", *options, cwd=tmp_path, env={"PYTHONPATH": str(PLANTED)})
    assert ran.code == 3
    assert verdicts(ran.out) == {"a.obj": "pass", f"{word}.obj": "incomplete", "z.obj": "pass"}
    lost = ran.document["assets"][1]["report"]
    (issue,) = (each for each in lost["issues"] if each["code"] == code)
    assert issue["message"].endswith(how)


def test_a_report_in_json_has_times_and_sums_where_they_are_wanted(assets: Path) -> None:
    given = ("batch", str(assets), "--format", "json")
    text_of = {timed: satcheck(*given, *timed).out for timed in ((), ("--no-timings",))}
    has_times = {timed: '"microseconds"' in out for timed, out in text_of.items()}
    assert has_times == {(): True, ("--no-timings",): False}
    assert all('"sha256"' in out for out in text_of.values())


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names")
def test_assets_of_odd_names_come_back_from_their_process(assets: Path) -> None:
    (assets / "props" / "box.obj").rename(assets / "props" / os.fsdecode(b"b\xff.obj"))
    ran = satcheck("batch", str(assets), "--format", "json")
    assert ran.code == 1
    assert verdicts(ran.out) == {"gripper.glb": "fail", os.fsdecode(b"b\xff.obj"): "pass"}
