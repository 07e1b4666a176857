"""The recipes of docs/batch.md run as they stand there, with two shards instead of eight."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sysconfig
from pathlib import Path

import pytest

from satcheck.audit.batch.stored import merge
from tests.audit.batch.worlds import make_worlds
from tests.cli.process import environment, on_posix, private_cache, satcheck
from tests.test_docs import BLOCK, ROOT

pytestmark = on_posix
SHARDS = ("1", "2")
# As `aws s3 ls` does, it finds every name that begins with the one it is given.
_AWS = """#!/bin/sh
ls -d "${3#file://}"*
"""


def recipe(language: str, word: str) -> str:
    """The block of the page that has this word."""
    blocks = BLOCK.findall((ROOT / "docs" / "batch.md").read_text("utf-8"))
    (text,) = (text for name, text in blocks if name == language and word in text)
    return re.sub(r"/8\b", "/2", text).replace("1 2 3 4 5 6 7 8", "1 2").replace("(1, 9)", "(1, 3)")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("scenes", "results", "bin"):
        (tmp_path / name).mkdir()
    make_worlds(tmp_path / "scenes", 6)
    satcheck("batch", "scenes", "-o", "expected.jsonl", cwd=tmp_path)
    (tmp_path / "bin" / "aws").write_text(_AWS)
    (tmp_path / "bin" / "aws").chmod(0o755)
    return tmp_path


def run(folder: Path, *command: str, **variables: str) -> None:
    path = [str(folder / "bin"), sysconfig.get_path("scripts"), os.environ["PATH"]]
    env = environment({**variables, **private_cache(folder / "cache")})
    env["PATH"] = os.pathsep.join(path)
    ran = subprocess.run(command, cwd=folder, env=env, capture_output=True, check=False)
    assert ran.returncode == 0, ran.stderr.decode()


def check_results(folder: Path, expected: str = "expected.jsonl") -> None:
    merge([folder / "results" / f"{shard}.jsonl" for shard in SHARDS], folder / "merged.jsonl")
    assert (folder / "merged.jsonl").read_bytes() == (folder / expected).read_bytes()


def test_slurm(folder: Path) -> None:
    for shard in SHARDS:
        run(folder, "bash", "-c", recipe("bash", "SLURM"), SLURM_ARRAY_TASK_ID=shard)
    check_results(folder)


def test_aws_batch(folder: Path) -> None:
    scenes = sorted((folder / "scenes").glob("*.toml"))
    (folder / "manifest.txt").write_text("".join(f"{scene.as_uri()}\n" for scene in scenes))
    satcheck("batch", "--manifest", "manifest.txt", "-o", "far.jsonl", cwd=folder)
    for shard in SHARDS:
        index = str(int(shard) - 1)
        variables = {"AWS_BATCH_JOB_ARRAY_INDEX": index, "LIBRARY": folder.as_uri()}
        run(folder, "bash", "-c", recipe("bash", "AWS"), **variables)
    check_results(folder, "far.jsonl")


def test_aws_batch_fails_a_shard_that_has_not_finished(folder: Path) -> None:
    (folder / "results" / "1.jsonl.part").touch()
    is_finished = recipe("bash", "AWS").splitlines()[-1]
    env = {"PATH": os.pathsep.join((str(folder / "bin"), os.environ["PATH"]))}
    env["out"] = (folder / "results" / "1.jsonl").as_uri()
    assert subprocess.run(["bash", "-c", is_finished], env=env, check=False).returncode != 0


def needs(tool: str) -> pytest.MarkDecorator:
    return pytest.mark.skipif(shutil.which(tool) is None, reason=f"{tool} is not installed")


@needs("parallel")
def test_gnu_parallel(folder: Path) -> None:
    run(folder, "bash", "-c", recipe("bash", "parallel"))
    check_results(folder)


@needs("snakemake")
def test_snakemake(folder: Path) -> None:
    (folder / "Snakefile").write_text(recipe("snakemake", "rule"))
    run(folder, "snakemake", "--cores", "2")
    check_results(folder)
