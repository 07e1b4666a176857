"""What the fast paths import: modules, never clocks. Start-up time is made of imports."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.cli.process import private_cache, satcheck

# What no answer about two small convex meshes may wait for.
HEAVY = {
    "asyncio",
    "coacd",
    "concurrent.futures",
    "ctypes",
    "fcl",
    "importlib.metadata",
    "jsonschema",
    "lxml",
    "manifold3d",
    "msgspec",
    "multiprocessing",
    "networkx",
    "numpy",
    "platformdirs",
    "filelock",
    "scipy",
    "subprocess",
    "trimesh",
}
GEOMETRY = {"satcheck.audit", "satcheck.core._native", "satcheck.scene", "rich"}


def imported(*arguments: str, code: int, env: Mapping[str, str] | None = None) -> set[str]:
    """Every module that the process imported."""
    ran = satcheck(*arguments, python=("-X", "importtime"), env=env)
    assert ran.code == code, ran.err[-2000:]
    lines = [line for line in ran.err.splitlines() if line.startswith("import time:")]
    return {line.rsplit("|", 1)[1].strip() for line in lines}


@pytest.mark.parametrize("form", ["table", "json"])
def test_two_small_convex_meshes(form: str) -> None:
    names = imported("--format", form, "box.obj", "box_pushed.stl", code=1)
    assert names & HEAVY == set()
    assert not {name for name in names if name.startswith(("rich.progress", "rich.live"))}


@pytest.mark.parametrize("option", ["--contacts", "--volume"])
def test_what_was_not_asked_for_is_not_there(option: str) -> None:
    """Nor does asking load manifold3d or numpy here: they work in the child."""
    figures = "satcheck.audit.figures"
    stages = {"--contacts": f"{figures}.contacts", "--volume": f"{figures}.volume"}
    arguments = ("--format", "json", "box.obj", "box_pushed.stl")
    without, asked = imported(*arguments, code=1), imported(option, *arguments, code=1)
    assert without & set(stages.values()) == set()
    assert stages[option] in asked
    assert {"manifold3d", "numpy"} & asked == set()


def test_without_a_depth_its_search_is_not_even_imported() -> None:
    search = {"satcheck.audit.figures.depth", "satcheck.audit.figures.concave_depth"}
    arguments = ("--format", "json", "l_bracket.obj", "peg_in_arm.ply")
    assert imported("--no-depth", *arguments, code=1) & search == set()
    assert search <= imported("--depth", *arguments, code=1)


def test_json_needs_no_table() -> None:
    """Nor what only a table, dataclasses or threads bring along, nor what the core does itself."""
    names = imported("--format", "json", "box.obj", "box_pushed.stl", code=1)
    spared = {"rich", "dataclasses", "shutil", "logging", "click.shell_completion"}
    assert names & (spared | {"hashlib", "json", "struct", "threading"}) == set()


@pytest.mark.parametrize("arguments", [("--help",), ("--version",), ("schema",)])
def test_help_needs_no_geometry(arguments: tuple[str, ...]) -> None:
    assert imported(*arguments, code=0) & (HEAVY | GEOMETRY) == set()


def test_completion_needs_no_geometry() -> None:
    shell = {"_SATCHECK_COMPLETE": "bash_complete", "COMP_WORDS": "satcheck -", "COMP_CWORD": "1"}
    names = imported(code=0, env=shell)
    assert names & GEOMETRY == set()


def test_the_second_run_on_a_concave_pair_does_not_import_coacd(tmp_path: Path) -> None:
    """Nor does the first, in this process: parts are made in a child, and then cached."""
    places = private_cache(tmp_path)
    pair = ("l_bracket.obj", "peg_in_arm.ply")
    first = satcheck("--format", "json", "--no-timings", *pair, env=places)
    names = imported("--format", "json", "--no-timings", *pair, code=1, env=places)
    second = satcheck("--format", "json", "--no-timings", *pair, env=places)
    assert "coacd" not in names
    assert "satcheck.core.worker" not in names
    assert first.out == second.out


def test_a_plain_call_needs_no_click() -> None:
    names = imported("--format", "json", "--no-depth", "box.obj", "box_pushed.stl", code=1)
    assert not {name for name in names if name.startswith("click")}
    assert names & {"inspect", "uuid", "difflib"} == set()
    assert "click" in imported("--format=json", "box.obj", "box_pushed.stl", code=1)
