"""A package outside of this repository brings formats and a command, by entry points."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from satcheck.core import plugins
from tests.cli.process import SAMPLES, Ran, satcheck
from tests.scene.test_changed_assets import git

PACKAGE = Path(__file__).parent / "outside" / "tetra.py"
UNIT = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
FAR = "5 0 0\n6 0 0\n5 1 0\n5 0 1\n"


def install(folder: Path, points: str) -> dict[str, str]:
    """The environment in which the package is installed. points: the text of its entry points."""
    folder.mkdir()
    shutil.copy(PACKAGE, folder)
    made = folder / "tetra-1.0.dist-info"
    made.mkdir()
    (made / "METADATA").write_text("Metadata-Version: 2.1\nName: tetra\nVersion: 1.0\n")
    (made / "entry_points.txt").write_text(points)
    return {"PYTHONPATH": str(folder)}


@pytest.fixture
def env(tmp_path: Path) -> dict[str, str]:
    points = (
        "[satcheck.readers]\ntetra = tetra:READER\n"
        "[satcheck.formats]\nverdicts = tetra:FORMAT\n"
        "[satcheck.commands]\ncorners = tetra:COMMAND\n"
    )
    (tmp_path / "a.tetra").write_text(UNIT)
    (tmp_path / "b.tetra").write_text(UNIT.replace("1", "0.5"))
    (tmp_path / "far.tetra").write_text(FAR)
    return install(tmp_path / "installed", points)


def test_its_files_are_meshes(tmp_path: Path, env: dict[str, str]) -> None:
    ran = satcheck("a.tetra", "b.tetra", "--format", "json", cwd=tmp_path, env=env)
    assert ran.code == 1
    assert ran.document["findings"][0]["relation"] == "penetrating"
    assert ran.document["bodies"][0]["file"] == "a.tetra"
    assert satcheck("a.tetra", "far.tetra", cwd=tmp_path, env=env).code == 0
    assert satcheck("a.tetra", "far.tetra", cwd=tmp_path).code == 2


def test_a_reader_that_dies_on_an_empty_file_ends_no_check(tmp_path: Path) -> None:
    env = install(tmp_path / "installed", "[satcheck.readers]\ndead = dead:READER\n")
    (tmp_path / "installed" / "dead.py").write_text(
        "import os\nfrom satcheck.scene.files.readers import Reader\n"
        "READER = Reader('dead', 'DEAD', ('.dead',), 'dead:read')\n"
        "def read(file):\n    os._exit(77)\n"
    )
    for content in ("", "1"):
        (tmp_path / "a.dead").write_text(content)
        ran = satcheck("a.dead", str(SAMPLES / "box.obj"), cwd=tmp_path, env=env)
        assert ran.code == 2
        assert "a.dead: the DEAD reader died" in ran.err


def test_a_file_of_its_format_that_names_a_changed_one_has_changed(
    tmp_path: Path, env: dict[str, str]
) -> None:
    (tmp_path / "a.tetra").write_text("see far.tetra")
    for words in (("init", "-q"), ("add", "."), ("commit", "-qm", "first")):
        git(tmp_path, *words)
    (tmp_path / "far.tetra").write_text(UNIT)
    ran = satcheck(
        "batch", ".", "--changed-since", "HEAD", "--format", "json", cwd=tmp_path, env=env
    )
    assert [asset["file"] for asset in ran.document["assets"]] == ["a.tetra", "far.tetra"]


def test_a_folder_is_checked_for_its_files(tmp_path: Path, env: dict[str, str]) -> None:
    ran = satcheck("batch", ".", "--format", "json", cwd=tmp_path, env=env)
    assert [asset["file"] for asset in ran.document["assets"]] == [
        "a.tetra",
        "b.tetra",
        "far.tetra",
    ]


def test_what_it_refuses_is_said_of_its_file(tmp_path: Path, env: dict[str, str]) -> None:
    (tmp_path / "a.tetra").write_text("0 0\n")
    ran = satcheck("a.tetra", "b.tetra", "far.tetra", cwd=tmp_path, env=env)
    assert ran.code == 2
    assert "a.tetra: not four corners" in ran.err


@pytest.mark.parametrize("words", [("--format", "verdicts"), ("-o", "x.verdicts")])
def test_reports_are_written_in_its_format(
    words: tuple[str, ...], tmp_path: Path, env: dict[str, str]
) -> None:
    ran = satcheck("a.tetra", "far.tetra", *words, cwd=tmp_path, env=env)
    written = (tmp_path / "x.verdicts").read_text() if "-o" in words else ran.out
    assert written == "satcheck: pass\n"
    assert satcheck("a.tetra", "far.tetra", *words[:1], "verdicts", cwd=tmp_path).code == 2


def test_its_command_is_one_of_satcheck(tmp_path: Path, env: dict[str, str]) -> None:
    assert satcheck("corners", "a.tetra", cwd=tmp_path, env=env).out == "4\n"
    assert "corners" in satcheck("--help", cwd=tmp_path, env=env).out
    assert satcheck("corners", "a.tetra", cwd=tmp_path).code == 2


@pytest.mark.parametrize(("name", "why"), [("NOTHING", "no attribute"), ("SHIFTED", "$.title")])
def test_a_package_that_fails_is_named_and_harms_nobody(
    name: str, why: str, tmp_path: Path
) -> None:
    env = install(tmp_path / "broken", f"[satcheck.readers]\nbad = tetra:{name}\n")
    with (tmp_path / "broken" / "tetra.py").open("a") as module:
        module.write('SHIFTED = Reader("tetra", 5, "TETRA", ".tetra")\n')
    (tmp_path / "a.tetra").write_text(UNIT)
    (tmp_path / "a.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    )
    ran = satcheck("a.obj", "a.tetra", "a.obj", "--format", "json", cwd=tmp_path, env=env)
    assert ran.code == 2
    relations = {finding["relation"] for finding in ran.document["findings"]}
    assert relations == {"coincident", "indeterminate"}
    assert f"tetra:{name} cannot be loaded" in ran.err
    assert why in ran.err


def test_a_reader_that_is_not_complete_says_so_of_a_whole_file(
    tmp_path: Path, env: dict[str, str]
) -> None:
    module = Path(env["PYTHONPATH"]) / "tetra.py"
    module.write_text(module.read_text().replace('text="plain"', 'text="plain", complete=False'))
    ran = satcheck("a.tetra", "far.tetra", "--format", "json", cwd=tmp_path, env=env)
    assert ran.code == 3
    assert [issue["code"] for issue in ran.document["issues"]] == ["incomplete", "incomplete"]


def test_a_reader_that_fails_loses_its_file_alone(tmp_path: Path, env: dict[str, str]) -> None:
    module = Path(env["PYTHONPATH"]) / "tetra.py"
    module.write_text(module.read_text().replace("    try:", "    {}[1]\n    try:", 1))
    ran = satcheck("a.tetra", "b.tetra", "--format", "json", cwd=tmp_path, env=env)
    assert ran.code == 2
    assert "the TETRA reader failed: KeyError" in ran.err


@pytest.mark.parametrize("split", ["none", "nodes", "components"])
@pytest.mark.parametrize("points", ["points", 'b""'])
def test_a_mesh_without_triangles_is_empty(
    points: str, split: str, tmp_path: Path, env: dict[str, str]
) -> None:
    module = Path(env["PYTHONPATH"]) / "tetra.py"
    module.write_text(module.read_text().replace("(points, triangles", f'({points}, b""'))
    ran = satcheck(
        "a.tetra", "b.tetra", "--split", split, "--format", "json", cwd=tmp_path, env=env
    )
    assert ran.code == 2
    assert [issue["code"] for issue in ran.document["issues"]] == ["empty-mesh", "empty-mesh"]


def test_the_line_of_a_refusal_is_said(tmp_path: Path, env: dict[str, str]) -> None:
    module = Path(env["PYTHONPATH"]) / "tetra.py"
    module.write_text(module.read_text().replace('{error}")', '{error}", line=7)'))
    (tmp_path / "a.tetra").write_text("0 0\n")
    ran = satcheck("a.tetra", "b.tetra", cwd=tmp_path, env=env)
    assert ran.code == 2
    assert "a.tetra: line 7: not four corners" in ran.err


def test_an_option_of_its_reader_is_one_of_satcheck(tmp_path: Path, env: dict[str, str]) -> None:
    """By the command, a scene file, a config file and in a batch; the report states it, so that
    it can be verified."""

    def run(*words: str) -> Ran:
        return satcheck(*words, cwd=tmp_path, env=env)

    pair = ("a.tetra", "far.tetra")
    wide = ("--read", "tetra-scale=10")
    assert run(*pair).code == 0
    assert run("a.tetra", "b.tetra", "--read", "tetra-scale=0.5").code == 1
    ran = run("a.tetra", *wide, "--format", "json", "a.tetra", "--certificate", "-o", "r.json")
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["reading"] == {"tetra_scale": 10.0}
    assert report["findings"][0]["depth"] > 5
    assert (ran.code, run("verify", "r.json").code) == (1, 0)

    bodies = '[[bodies]]\nid = "a"\nmesh = "a.tetra"\n[[bodies]]\nid = "b"\n'
    bodies += 'shape = {type = "box", size = [1, 1, 1]}\nposition = [3, 3, 3]\n'
    for stated, code in (("", 0), ("reading.tetra_scale = 20\n", 1)):
        (tmp_path / "scene.toml").write_text(f'schema = "satcheck.scene/1"\n{stated}{bodies}')
        assert run("scene.toml").code == code
    assert run("scene.toml", "--read", "tetra-scale=1").code == 0
    for words, code in (((), 1), (("--read", "tetra-scale=1", "--resume"), 0)):
        assert run("batch", "scene.toml", "-o", "r.jsonl", *words).code == code


def test_it_is_in_the_help_of_all_options_and_in_the_schema(
    tmp_path: Path, env: dict[str, str]
) -> None:
    """The short help does not load the readers of other packages."""
    module = Path(env["PYTHONPATH"]) / "tetra.py"
    module.write_text(module.read_text().replace('(".verdicts",)', '(".vdt",)'))

    def run(*words: str) -> str:
        return "".join(satcheck(*words, cwd=tmp_path, env=env).out.split())

    for name in ("TETRA", "tetra-scale", "verdicts(.vdt)"):
        assert (name in run("--help"), name in run("--help-all")) == (False, True)
    assert "tetra-scale" in run("batch", "--help-all")
    schema = json.loads(run("schema", "scene"))
    assert schema["$defs"]["Reading"]["properties"]["tetra_scale"]["exclusiveMinimum"] == 0
    config = json.loads(run("schema", "config"))["properties"]
    assert "verdicts" in config["format"]["enum"]
    assert "tetra-scale" in config["read"]["description"]


def test_results_of_another_state_of_it_are_not_kept(tmp_path: Path, env: dict[str, str]) -> None:
    """Its version stays the same, as it does while somebody writes it."""
    bodies = "".join(f'[[bodies]]\nid = "{k}"\nmesh = "{k}.tetra"\n' for k in ("a", "far"))
    (tmp_path / "scene.toml").write_text(f'schema = "satcheck.scene/1"\n{bodies}')
    words = ("batch", "scene.toml", "-o", "r.jsonl")
    assert satcheck(*words, cwd=tmp_path, env=env).code == 0
    module = Path(env["PYTHONPATH"]) / "tetra.py"
    same = "b'0 0 0 1 0 0 0 1 0 0 0 1'"  # whatever the file says
    module.write_text(module.read_text().replace("bytes(file.data)", same))
    assert satcheck(*words, "--resume", cwd=tmp_path, env=env).code == 1


def test_every_module_of_a_package_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its entry point names one module, and the reader may be in another."""
    folder = tmp_path / "shapes_of_somebody"
    folder.mkdir()
    for name in ("__init__", "readers", "reading"):
        (folder / f"{name}.py").write_text("")
    monkeypatch.syspath_prepend(tmp_path)
    before = plugins._state("shapes_of_somebody.readers")
    assert before == plugins._state("shapes_of_somebody.readers")
    (folder / "reading.py").write_text("READ = 1\n")
    assert plugins._state("shapes_of_somebody.readers") != before


def test_a_choice_of_its_option_is_said_in_a_scene(tmp_path: Path, env: dict[str, str]) -> None:
    module = Path(env["PYTHONPATH"]) / "tetra.py"
    choice = 'Option("tetra_surface", Literal["fine", "coarse"], "the surface", "fine")'
    changed = module.read_text().replace("options=(SCALE,)", f"options=(SCALE, {choice})")
    module.write_text(changed.replace("import Annotated", "import Annotated, Literal"))
    scene = 'schema = "satcheck.scene/1"\nreading.tetra_surface = "corse"\nbodies = []\n'
    (tmp_path / "scene.toml").write_text(scene)
    ran = satcheck("scene.toml", cwd=tmp_path, env=env)
    assert (ran.code, "one of fine, coarse expected" in ran.err) == (2, True)


def test_an_option_with_a_name_that_is_none_fails_as_the_package_does(tmp_path: Path) -> None:
    env = install(tmp_path / "odd", "[satcheck.readers]\nodd = tetra:READER\n")
    module = Path(env["PYTHONPATH"]) / "tetra.py"
    module.write_text(module.read_text().replace('"tetra_scale"', '"tetra-scale"'))
    (tmp_path / "a.tetra").write_text(UNIT)
    ran = satcheck("a.tetra", "a.tetra", cwd=tmp_path, env=env)
    assert (ran.code, "named 'tetra-scale': letters" in ran.err) == (2, True)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--read", "tetra-scale=0"), "should be another value (the factor of all corners"),
        (("--read", "tetra-skale=2"), "there are"),
        (("box.obj", "--read", "tetra-scale=2"), "has the option tetra-scale: they have none"),
    ],
)
def test_what_is_wrong_with_its_option_is_said(
    words: tuple[str, ...], said: str, tmp_path: Path, env: dict[str, str]
) -> None:
    shutil.copy(SAMPLES / "box.obj", tmp_path)
    files = ("box.obj",) if "box.obj" in words else ("a.tetra", "b.tetra")
    ran = satcheck(*files, *words, cwd=tmp_path, env=env)
    assert ran.code == 2
    assert said in " ".join(ran.err.split())


def test_an_entry_point_of_another_kind_is_a_failure(tmp_path: Path) -> None:
    env = install(tmp_path / "odd", "[satcheck.readers]\nodd = tetra:_FACES\n")
    (tmp_path / "a.tetra").write_text(UNIT)
    ran = satcheck("a.tetra", "a.tetra", cwd=tmp_path, env=env)
    assert ran.code == 2
    assert "tuple is not what registers there" in ran.err


ROBOT = """
from satcheck.scene.files.readers import Reader
READ = "satcheck.scene.robot.urdf:read_urdf"
ROBOT = Reader("rbx", "RBX", (".rbx",), READ, kind="robot", roots=("rbx",))
"""


def test_its_robots_are_assets_of_a_folder(tmp_path: Path) -> None:
    env = install(tmp_path / "robots", "[satcheck.readers]\nrbx = robots:ROBOT\n")
    (tmp_path / "robots" / "robots.py").write_text(ROBOT)
    box = '<link name="{}"><collision><geometry><box size="1 1 1"/></geometry></collision></link>'
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="c"/></joint>'
    joint += '<joint name="k" type="fixed"><parent link="c"/><child link="b"/></joint>'
    links = box.format("a") + '<link name="c"/>' + box.format("b")
    for name in ("a", "b"):
        (tmp_path / f"{name}.rbx").write_text(f'<rbx name="r">{links}{joint}</rbx>')
    ran = satcheck("batch", ".", "--format", "json", cwd=tmp_path, env=env)
    assert [asset["verdict"] for asset in ran.document["assets"]] == ["fail", "fail"]


def test_a_reader_of_robots_that_fails_loses_its_file_alone(tmp_path: Path) -> None:
    env = install(tmp_path / "robots", "[satcheck.readers]\nrbx = robots:ROBOT\n")
    failing = ROBOT.replace("satcheck.scene.robot.urdf:read_urdf", "robots:fail")
    (tmp_path / "robots" / "robots.py").write_text(f"{failing}def fail(file):\n    {{}}[1]\n")
    (tmp_path / "a.rbx").write_text('<rbx name="r"><link name="a"/></rbx>')
    shutil.copy(SAMPLES / "box.obj", tmp_path)
    ran = satcheck("batch", ".", "--format", "json", cwd=tmp_path, env=env)
    verdicts = {asset["file"]: asset["verdict"] for asset in ran.document["assets"]}
    assert verdicts == {"a.rbx": "error", "box.obj": "pass"}
    assert "the RBX reader failed: KeyError" in ran.out
