"""Run the command in a process of its own, as a user or a script would."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from jsonschema import Draft202012Validator

from satcheck.cli.commands.schema import text
from tests.oracles.fits_touch import assert_fits_touch

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
    """In a fork (forked.py), unless the interpreter itself is told something as it starts."""
    variables = environment(env)
    told = stdin is not None or python or any(name.startswith("PYTHON") for name in env or ())
    if told or os.name != "posix":
        done = subprocess.run(
            command(*arguments, python=python),
            input=None if stdin is None else stdin.encode(),
            cwd=cwd,
            env=variables,
            capture_output=True,
            timeout=SECONDS,
            check=False,
        )
        code, out, err = done.returncode, done.stdout, done.stderr
    else:
        from tests.cli.forked import run_forked

        code, out, err = run_forked(arguments, cwd, variables, SECONDS)
    ran = Ran(code, out.decode("utf-8"), err.decode("utf-8", "replace"))
    _judge(ran.out)
    for place, option in enumerate(arguments[:-1]):
        if option in ("-o", "--output") and arguments[place + 1].endswith(".json"):
            with suppress(OSError):  # some tests name what cannot be written
                _judge((cwd / arguments[place + 1]).read_text(encoding="utf-8"))
    return ran


def _judge(text: str) -> None:
    """No fit is a collision, in any report."""
    if text.startswith("{"):
        with suppress(json.JSONDecodeError):
            assert_fits_touch(json.loads(text))
