"""What a check imports: modules, never clocks. A check of two small meshes takes no longer than
`import numpy`, so it must import neither numpy nor any other large library."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from satcheck.cli.commands import COMMANDS
from tests.cli.process import SAMPLES, private_cache, satcheck

HEAVY = {
    "DracoPy",
    "asyncio",
    "coacd",
    "collada",
    "ezdxf",
    "fcl",
    "jsonschema",
    "lxml",
    "manifold3d",
    "matplotlib",
    "multiprocessing",
    "networkx",
    "numpy",
    "pxr",
    "rich.live",
    "rich.progress",
    "scipy",
    "trimesh",
}


def imported(
    *arguments: str, code: int, env: Mapping[str, str] | None = None, cwd: Path = SAMPLES
) -> set[str]:
    """Every module that the process imported."""
    ran = satcheck(*arguments, python=("-X", "importtime"), env=env, cwd=cwd)
    assert ran.code == code, ran.err[-2000:]
    lines = [line for line in ran.err.splitlines() if line.startswith("import time:")]
    return {line.rsplit("|", 1)[1].strip() for line in lines}


@pytest.mark.parametrize("form", ["table", "json"])
def test_a_check_imports_no_large_library(form: str) -> None:
    names = imported("--format", form, "box.obj", "box_pushed.stl", code=1)
    assert names & HEAVY == set()
    assert ("rich" in names) == (form == "table")


@pytest.mark.parametrize("option", ["--contacts", "--components", "--volume"])
def test_figures_import_no_large_library(option: str) -> None:
    """manifold3d and numpy work in a child process."""
    names = imported(option, "--format", "json", "box.obj", "box_pushed.stl", code=1)
    assert names & HEAVY == set()


@pytest.mark.parametrize("arguments", [("--help",), ("--version",), ("schema",)])
def test_help_imports_no_large_library(arguments: tuple[str, ...]) -> None:
    names = imported(*arguments, code=0)
    assert names & (HEAVY | {f"satcheck.cli.commands.{name}" for name in COMMANDS}) <= {
        f"satcheck.cli.commands.{arguments[0]}"
    }


def test_completion_imports_no_large_library() -> None:
    shell = {"_SATCHECK_COMPLETE": "bash_complete", "COMP_WORDS": "satcheck -", "COMP_CWORD": "1"}
    assert imported(code=0, env=shell) & HEAVY == set()


def test_the_second_run_on_a_concave_pair_imports_no_coacd(tmp_path: Path) -> None:
    """Nor does the first, in this process: parts are made in a child process, and then cached."""
    places = private_cache(tmp_path)
    parts = ("--accuracy", "parts", "--no-timings", "l_bracket.obj", "peg_in_arm.ply")
    first = satcheck(*parts, env=places)
    names = imported(*parts, code=first.code, env=places)
    second = satcheck(*parts, env=places)
    assert "coacd" not in names
    assert first.out == second.out
