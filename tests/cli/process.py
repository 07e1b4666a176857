"""Run the command as a whole process, as a user or a script would."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from jsonschema import Draft202012Validator

from satcheck.cli.report.schema import text

SAMPLES = Path(__file__).resolve().parent.parent.parent / "sample_meshes"
SECONDS = 120
PUSHED = ("box.obj", "box_pushed.stl")
APART = ("box.obj", "cube.off")
VALIDATOR = Draft202012Validator(json.loads(text()))
on_posix = pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell or terminal")
# What could change the answer of a test from outside.
_NEUTRAL = ("NO_COLOR", "FORCE_COLOR", "COLUMNS", "PYTHONIOENCODING", "PYTHONUTF8", "TERM")


class Ran(NamedTuple):
    code: int
    out: str
    err: str

    @property
    def document(self) -> dict[str, Any]:
        """Standard output as exactly one JSON document."""
        value = json.loads(self.out)
        assert isinstance(value, dict)
        return value


def command(*arguments: str, python: tuple[str, ...] = ()) -> list[str]:
    return [sys.executable, *python, "-m", "satcheck.cli", *arguments]


def environment(variables: Mapping[str, str] | None = None) -> dict[str, str]:
    """Ours without what could change an answer, with `variables`; PYTHONPATH is put in front."""
    made = {name: value for name, value in os.environ.items() if name not in _NEUTRAL}
    made |= {"PYTHONUTF8": "1", **(variables or {})}
    if variables and "PYTHONPATH" in variables and "PYTHONPATH" in os.environ:
        made["PYTHONPATH"] += os.pathsep + os.environ["PYTHONPATH"]
    return made


def private_cache(folder: Path) -> dict[str, str]:
    """Variables that give a test a cache of its own."""
    return {"SATCHECK_CACHE_DIR": str(folder)}


def satcheck(
    *arguments: str,
    env: Mapping[str, str] | None = None,
    cwd: Path = SAMPLES,
    python: tuple[str, ...] = (),
    stdin: str | None = None,
) -> Ran:
    done = subprocess.run(
        command(*arguments, python=python),
        input=None if stdin is None else stdin.encode(),
        cwd=cwd,
        env=environment(env),
        capture_output=True,
        timeout=SECONDS,
        check=False,
    )
    return Ran(done.returncode, done.stdout.decode("utf-8"), done.stderr.decode("utf-8", "replace"))
