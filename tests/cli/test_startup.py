"""What a check imports: modules, never clocks. A check of two small meshes takes no longer than
`import numpy`, so it must import neither numpy nor any other large library."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from satcheck.cli.commands import COMMANDS
from tests.cli.process import SAMPLES, private_cache, satcheck
from tests.plugin_marks import needs

HEAVY = {
    "DracoPy",
    "asyncio",
    "coacd",
    "collada",
    "fcl",
    "ifcopenshell",
    "jsonschema",
    "lxml",
    "manifold3d",
    "matplotlib",
    "mujoco",
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


def test_a_file_of_findings_imports_no_large_library(tmp_path: Path) -> None:
    report = str(tmp_path / "report.json")
    assert imported("box.obj", "box_pushed.stl", "-o", report, code=1) & HEAVY == set()


@pytest.mark.parametrize("option", ["--contacts", "--components", "--volume"])
def test_figures_import_no_large_library(option: str) -> None:
    """manifold3d and numpy work in a child process."""
    names = imported(option, "--format", "json", "box.obj", "box_pushed.stl", code=1)
    assert names & HEAVY == set()


@needs("mjcf")
def test_a_model_of_mujoco_is_read_in_a_child_process() -> None:
    assert "mujoco" not in imported("--format", "json", "lift.xml", code=0)


@pytest.mark.parametrize("arguments", [("--help",), ("--version",), ("schema",)])
def test_help_imports_no_large_library(arguments: tuple[str, ...]) -> None:
    names = imported(*arguments, code=0)
    assert names & (HEAVY | {f"satcheck.cli.commands.{name}" for name in COMMANDS}) <= {
        f"satcheck.cli.commands.{arguments[0]}"
    }


def test_completion_imports_no_large_library() -> None:
    shell = {"_SATCHECK_COMPLETE": "bash_complete", "COMP_WORDS": "satcheck -", "COMP_CWORD": "1"}
    assert imported(code=0, env=shell) & HEAVY == set()


def test_a_batch_imports_no_large_library(tmp_path: Path) -> None:
    results = str(tmp_path / "results.jsonl")
    names = imported("batch", "box.obj", "cell.toml", "-o", results, "--exit-zero", code=0)
    assert names & HEAVY == set()


def test_a_slot_of_a_batch_imports_no_large_library(tmp_path: Path) -> None:
    """The child of a batch, on worlds whose pairs are apart, touch and overlap."""
    shutil.copy(SAMPLES / "box.obj", tmp_path)
    far = '[[bodies]]\nid = "{0}"\nmesh = "box.obj"\nposition = [{0}, 0, 0]\n'
    scene = f'schema = "satcheck.scene/1"\n{far.format(0)}{far.format(9)}'
    (tmp_path / "apart.toml").write_text(scene)
    code = """
import sys
from satcheck.audit.batch.options import CheckOptions
from satcheck.audit.batch.options import Limits
from satcheck.audit.batch.slot_server import Job, Wanted, answer_in, request_of, serve, text_of
worlds = ((sys.argv[1],), ("box.obj", "box_pushed.stl"), ("box.obj", "box_flush.stl"))
terms = text_of((CheckOptions(), Limits(), Wanted()))
answers = [answer_in(serve(request_of(Job(world), terms)), world) for world in worlds]
print(*[answer.verdict for answer in answers], file=sys.stderr)
print(*sys.modules)
"""
    ran = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "apart.toml")],
        cwd=SAMPLES,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.stderr.split() == ["pass", "fail", "pass"]
    assert set(ran.stdout.split()) & HEAVY == set()


def test_the_second_run_on_a_concave_pair_imports_no_coacd(tmp_path: Path) -> None:
    """Nor does the first, in this process: parts are made in a child process, and then cached."""
    places = private_cache(tmp_path)
    parts = ("--accuracy", "parts", "--no-timings", "l_bracket.obj", "peg_in_arm.ply")
    first = satcheck(*parts, env=places)
    names = imported(*parts, code=first.code, env=places)
    second = satcheck(*parts, env=places)
    assert "coacd" not in names
    assert first.out == second.out
