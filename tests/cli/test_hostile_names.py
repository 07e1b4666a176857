"""Names from files, in every output: text, and never what a reader obeys."""

from __future__ import annotations

import csv
import io
import json
import re
import shutil
import sys
import tomllib
import unicodedata
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.cli.process import satcheck
from tests.scene import files, graphs

WIDE = "\N{FULLWIDTH EQUALS SIGN}"
ESCAPE, BELL, REORDER, CONTROL = "\x1b", "\x07", "\u202e", "\x9b"
FORGED = "PASS: all is well"
MARKUP = [
    "</script><script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "<!-- ]]> &lt;&amp; &bomb;",
    "| a | b |",
    "`c` **b** [l](javascript:alert(1)) ![i](x) @all #1 www.a.b",
]
FORMULAS = ['=HYPERLINK("http://x")', "@SUM(1)", "+1", "-2+3", "\t=1", WIDE + "1"]
COMMANDS = [
    "a\n::error file=x::boom",
    "a\r\n::warning::boom",
    f"a\n{FORGED}",
    "%0A::error::boom",
    "x ##[add-mask]a",
    "##vso[task.setvariable variable=PATH]x",
]
TERMINAL = [
    f"{ESCAPE}[2J{ESCAPE}]0;title{BELL}",
    f"{CONTROL}31m",
    f"{REORDER}gnp.exe",
    "a\u2028b\u0085c",
    "\x00\x7f\x08",
    "\ud800",
]
PATHS = ["../../up", "/tmp/top", "C:\\x\\y", "con", "-rf", "--output=pwned", "a" * 300, "back\\"]
SHELL = ["$(touch pwned)", "`touch pwned`", "; touch pwned", "'\"", "&& touch pwned"]
NAMES = [*MARKUP, *FORMULAS, *COMMANDS, *TERMINAL, *PATHS, *SHELL]
AS_FILE = [n for n in NAMES if not re.search("[/\0\ud800]", n) and len(n.encode()) < 200]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scene, a GLB file and a folder of files with all these names, side by side."""
    place = tmp_path_factory.mktemp("hostile")
    (place / "cube.obj").write_bytes(files.obj())
    bodies = [
        {"id": name, "mesh": "cube.obj", "position": [0.9 * k, 0, 0]}
        for k, name in enumerate(NAMES)
    ]
    scene = {"schema": "satcheck.scene/1", "name": "".join(MARKUP), "bodies": bodies}
    (place / "scene.json").write_text(json.dumps(scene))
    nodes = [
        {"name": name, "mesh": 0, "translation": [0.9 * k, 0, 0]} for k, name in enumerate(NAMES)
    ]
    (place / "nodes.glb").write_bytes(graphs.glb(nodes, MARKUP[0]))
    (place / "files").mkdir()
    for name in AS_FILE if sys.platform != "win32" else ():
        (place / "files" / f"{name}.obj").write_bytes(files.obj())
    return place


INPUTS = {
    "scene": ["scene.json"],
    "nodes": ["nodes.glb"],
    "files": ["--", *(f"files/{name}.obj" for name in AS_FILE)],
}


def output(folder: Path, form: str, source: str) -> str:
    ran = satcheck("--format", form, *INPUTS[source], cwd=folder)
    assert ran.code == 1, ran.err
    assert_shown(ran.err)
    assert not (folder / "pwned").exists()
    return ran.out


# Controls, marks that reorder text, ends of lines, halves of characters.
_OBEYED = frozenset(("Cc", "Cf", "Zl", "Zp", "Cs"))


def assert_shown(text: str) -> None:
    """No line has what a terminal or a CI system obeys."""
    for line in text.split("\n"):
        assert _OBEYED.isdisjoint(map(unicodedata.category, line)), repr(line)
        assert not re.search(r"##\w*\[", line), line
        assert not line.startswith(("::", FORGED)), line


@pytest.mark.parametrize("source", INPUTS)
def test_a_terminal_shows_names_and_obeys_none(folder: Path, source: str) -> None:
    assert_shown(output(folder, "table", source))
    assert_shown(satcheck("--explain", *INPUTS[source], cwd=folder).out)


@pytest.mark.parametrize("source", INPUTS)
@pytest.mark.parametrize("form", ["json", "jsonl", "sarif"])
def test_json_holds_each_name_as_it_is(folder: Path, source: str, form: str) -> None:
    text = output(folder, form, source)
    assert_shown(text)
    documents = [json.loads(line) for line in text.splitlines()] if form == "jsonl" else [
        json.loads(text)
    ]  # fmt: skip
    held = json.dumps(documents, ensure_ascii=False)
    assert "alert(1)" in held
    if source == "scene" and form != "sarif":
        ids = {body["id"] for body in documents[0]["bodies"]}
        assert ids == set(NAMES)


@pytest.mark.parametrize("source", INPUTS)
def test_github_has_no_command_but_ours(folder: Path, source: str) -> None:
    for line in output(folder, "github", source).splitlines():
        assert line.isprintable()
        assert not re.search(r"##\w*\[", line)
        assert re.match(r"::(error|warning|notice) file=[^:]*,line=\d+,title=|satcheck: ", line)


@pytest.mark.parametrize("source", INPUTS)
def test_csv_has_no_formula(folder: Path, source: str) -> None:
    text = output(folder, "csv", source).removeprefix("\ufeff")
    rows = list(csv.reader(io.StringIO(text, newline="")))
    assert {len(row) for row in rows} == {len(rows[0])}
    for cell in (cell for row in rows for cell in row):
        assert cell.isprintable()
        assert cell[:1] not in ("=", "@", WIDE)
        if cell[:1] in ("+", "-"):
            float(cell)


@pytest.mark.parametrize("source", INPUTS)
def test_junit_is_xml(folder: Path, source: str) -> None:
    root = ElementTree.fromstring(output(folder, "junit", source))
    assert {element.tag for element in root.iter()} == {
        *("testsuites", "testsuite", "testcase", "failure", "system-out")
    }


@pytest.mark.parametrize("source", INPUTS)
def test_markdown_has_no_markup(folder: Path, source: str) -> None:
    text = output(folder, "markdown", source)
    assert_shown(text)
    for row in (line for line in text.split("\n") if line.startswith("| error")):
        assert len(re.findall(r"(?<!\\)\|", row)) == 4
        assert not re.search(r"(?<!\\)[<`*\[@]", row)
        assert "www." not in row


class _Page(HTMLParser):
    """The tags of a page, and the names of its attributes."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags += [tag, *(name for name, _ in attrs)]


def tags_of(page: str) -> list[str]:
    parser = _Page()
    parser.feed(page)
    return parser.tags


@pytest.mark.parametrize("source", INPUTS)
def test_a_page_has_the_elements_of_every_page(folder: Path, source: str) -> None:
    plain = satcheck("--format", "html", "cube.obj", "cube.obj", cwd=folder).out
    assert tags_of(output(folder, "html", source)) == tags_of(plain)


def test_each_and_verify_and_view(folder: Path) -> None:
    certified = satcheck("--certificate", "-o", "report.json", "scene.json", cwd=folder)
    assert_shown(certified.out + certified.err)
    for command in (
        ["batch", "files"],
        ["batch", "--format", "github", "files"],
        ["verify", "report.json"],
        ["view", "report.json", "-o", "page.html"],
        ["baseline", "write", "baseline.json", "report.json"],
        ["suggest", "scene.json"],
    ):
        ran = satcheck(*command, cwd=folder)
        assert "internal" not in ran.err, ran.err
        lines = ran.out if command[2:3] != ["github"] else ran.out.replace("::error ", "")
        assert_shown(lines + ran.err)


def test_parts_of_bodies_are_one_file(folder: Path) -> None:
    """Whatever the bodies are called: names never become paths, nor statements of the file."""
    before = _all_files(folder)
    ran = satcheck("decompose", "scene.json", "-o", "parts.obj", cwd=folder)
    assert_shown(ran.out + ran.err)
    assert _all_files(folder) - before == {"parts.obj"}
    lines = (folder / "parts.obj").read_text("utf-8").splitlines()
    assert all(re.match(r"#|[ovf] ", line) and not line.endswith("\\") for line in lines)
    assert sum(line.startswith("v ") for line in lines) == 8 * len(NAMES)


@pytest.mark.parametrize("name", ["out.toml", "out.scene.json"])
def test_a_scene_that_is_written_has_the_same_names(
    folder: Path, tmp_path: Path, name: str
) -> None:
    shutil.copytree(folder / "files", tmp_path / "files")
    ran = satcheck("resolve", *INPUTS["files"][1:], "-o", name, cwd=tmp_path)
    assert_shown(ran.out + ran.err)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["files", name]
    text = (tmp_path / name).read_text("utf-8")
    document = tomllib.loads(text) if name.endswith("toml") else json.loads(text)
    assert {body["mesh"] for body in document["bodies"]} == {f"files/{n}.obj" for n in AS_FILE}


def _all_files(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}
