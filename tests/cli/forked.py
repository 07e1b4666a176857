"""Run the command in a fork of a process that has imported it: a call starts no Python.

A call still has its own arguments, environment, folder, streams and exit code.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

COMMANDS = ("batch", "check", "suggest", "verify", "view")
# What they import when they run: most calls of the tests need it.
IMPORTED = (
    *(f"satcheck.cli.commands.{name}" for name in COMMANDS),
    *(
        "importlib.metadata",
        "numpy",
        "rich._emoji_codes",
        "rich.console",
        "rich.table",
        "tomllib._parser",
    ),
    *(f"satcheck.cli.{name}" for name in ("config", "entry", "formats.table", "interrupts")),
    *(f"satcheck.scene.{name}" for name in ("files.native_formats", "robot", "scene_file.reading")),
    *("satcheck.audit.batch.local", "satcheck.audit.batch.stored", "satcheck.audit.motion.sweep"),
    *("satcheck.audit.resolve.resolve", "satcheck.verify.document"),
)
CONTEXT = multiprocessing.get_context("forkserver")
CONTEXT.set_forkserver_preload([__name__, *IMPORTED])


def run_forked(
    arguments: tuple[str, ...], cwd: Path, env: Mapping[str, str], seconds: float
) -> tuple[int, bytes, bytes]:
    """Exit code, standard output, standard error.

    TimeoutError: the call took longer than `seconds`.
    """
    with tempfile.TemporaryDirectory() as folder:
        out, err = Path(folder, "out"), Path(folder, "err")
        call = CONTEXT.Process(target=_call, args=(arguments, cwd, dict(env), out, err))
        call.start()
        call.join(seconds)
        if call.exitcode is None:
            call.kill()
            call.join()
            raise TimeoutError(f"satcheck {' '.join(arguments)}: longer than {seconds} s")
        return call.exitcode, out.read_bytes(), err.read_bytes()


def _call(arguments: tuple[str, ...], cwd: Path, env: dict[str, str], out: Path, err: Path) -> None:
    from satcheck.cli import main

    for path, number in ((out, 1), (err, 2)):
        with path.open("wb") as file:
            os.dup2(file.fileno(), number)
    sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stderr = open(2, "w", encoding="utf-8", closefd=False, buffering=1)  # noqa: SIM115
    sys.argv = ["satcheck", *arguments]
    os.environ.clear()
    os.environ.update(env)
    os.chdir(cwd)
    main()
