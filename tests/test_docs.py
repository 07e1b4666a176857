"""The commands and programs in README and docs, run from the root: they print what the page shows.

A command stands behind `$ `, its output below it; a line `...` stands for any lines, and times
may differ. Every line that a Python program prints stands in its block.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.process import satcheck
from tests.plugin_marks import skip_without

ROOT = Path(__file__).resolve().parents[1]
PAGES = (
    ROOT / "README.md",
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "plugins").glob("*/README.md")),
)
_MORE = ("ARCHITECTURE.md", "CHANGELOG.md", "bench/README.md", "bench/accuracy-vs-time.md")
LINKING = (
    *PAGES,
    *(ROOT / name for name in _MORE),
)
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
TIME = re.compile(r" *\d+(\.\d+)? (us|ms|s)\b *")


def blocks(page: Path, language: str) -> list[str]:
    return [text for name, text in BLOCK.findall(page.read_text("utf-8")) if name == language]


def commands(block: str) -> list[tuple[str, str]]:
    """Each with the output that the page shows below it."""
    _, *parts = re.split(r"^\$ ", block, flags=re.MULTILINE)
    return [(part.split("\n", 1)[0], part.split("\n", 1)[1]) for part in parts]


WITH_COMMANDS = [
    pytest.param(block, id=f"{page.relative_to(ROOT)}-{number}")
    for page in PAGES
    for number, block in enumerate(blocks(page, ""))
    if commands(block)
]
PROGRAMS = [
    pytest.param(block, id=f"{page.relative_to(ROOT)}-{number}")
    for page in PAGES
    for number, block in enumerate(blocks(page, "python"))
]


SHELL_LINE = re.compile(r"^satcheck .*$", re.MULTILINE)
WITH_CALLS = [page for page in PAGES if any(map(SHELL_LINE.search, blocks(page, "")))]


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A copy of what the pages name, so that reports can be written beside it."""
    shutil.copytree(ROOT / "sample_meshes", tmp_path / "sample_meshes")
    (tmp_path / "docs").mkdir()
    for name in ("rig.step", "bench.usda", "room.toml", "squares.toml"):
        shutil.copy(ROOT / "docs" / name, tmp_path / "docs")
    return tmp_path


def run(arguments: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Its stdout holds both streams, in the order of writing."""
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=dict(os.environ, PYTHONIOENCODING="utf-8", COLUMNS="120", SATCHECK_CACHE="off"),
        encoding="utf-8",
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )


def without_times(text: str) -> str:
    return re.sub(r"[─ ]+", " ", TIME.sub(" TIME ", text))


def as_pattern(shown: str) -> str:
    lines = without_times(shown).splitlines()
    return "".join(r"(?:.*\n)*?" if line == "..." else f"{re.escape(line)}\n" for line in lines)


@pytest.mark.parametrize("block", WITH_COMMANDS)
def test_a_command_prints_what_the_page_shows(block: str, root: Path) -> None:
    for command, shown in commands(block):
        name, *arguments = shlex.split(command)
        assert name == "satcheck"
        printed = without_times(run(["-m", "satcheck.cli", *arguments], root).stdout)
        assert re.fullmatch(as_pattern(shown), printed), f"$ {command}\n{printed}"


def test_the_five_lines_of_the_squares_are_their_file() -> None:
    (shown,) = blocks(ROOT / "docs" / "bodies.md", "toml")
    assert shown == (ROOT / "docs" / "squares.toml").read_text("utf-8")


@pytest.mark.parametrize("page", WITH_CALLS, ids=lambda page: page.name)
def test_every_call_of_a_page_runs_from_the_root(page: Path, root: Path) -> None:
    """In their order, in one folder. Exit code 2 is wrong usage or a file that cannot be read."""
    for call in SHELL_LINE.findall("\n".join(blocks(page, ""))):
        _, *arguments = shlex.split(call, comments=True)
        assert satcheck(*arguments, cwd=root).code in (0, 1, 3), call


@pytest.mark.parametrize("block", PROGRAMS)
def test_a_program_prints_what_the_page_shows(block: str, root: Path) -> None:
    skip_without(re.findall(r"[\w./]+", block))
    printed = run(["-c", block], root).stdout.splitlines()
    assert printed
    assert [line for line in printed if line not in block] == []


def anchors(page: Path) -> set[str]:
    """Of the headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text("utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-") for text in headings}


@pytest.mark.parametrize("page", LINKING, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text("utf-8")):
        if target.startswith(("http:", "https:")):
            continue
        name, _, anchor = target.partition("#")
        other = (page.parent / name).resolve() if name else page
        if other.is_relative_to(ROOT / "plugins") and not (ROOT / "plugins").exists():
            continue
        assert other.exists(), target
        assert not anchor or anchor in anchors(other), target


@pytest.mark.parametrize("page", LINKING, ids=lambda page: page.name)
def test_named_files_exist(page: Path) -> None:
    """Files of the project, in the folders that pages name them from."""
    rooms = "audit|bench|cli|core|decompose|docs|sample_meshes|scene|tests|verify"
    endings = "py|hpp|cpp|obj|toml|json|urdf|md"
    named = re.findall(rf"`((?:{rooms})/[\w/.-]+\.(?:{endings}))`", page.read_text("utf-8"))
    assert [name for name in named if not (ROOT / name).exists()] == []
