"""The command as a whole process: what a pipe and a terminal get to see."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.cli.process import (
    PUSHED,
    SAMPLES,
    command,
    environment,
    on_posix,
    satcheck,
)


@pytest.mark.parametrize(
    ("variables", "width"),
    [({}, 120), ({"COLUMNS": "40"}, 40), ({"COLUMNS": "200"}, 200), ({"COLUMNS": "no"}, 120)],
)
def test_a_pipe_gets_plain_text_of_its_width(
    variables: dict[str, str], width: int, tmp_path: Path
) -> None:
    long = tmp_path / f"{'x' * 250}.obj"
    shutil.copy(SAMPLES / "box.obj", long)
    ran = satcheck(str(long), *PUSHED, env=variables)
    assert "\x1b" not in ran.out + ran.err
    assert max(map(len, ran.out.splitlines())) == width


@pytest.mark.parametrize(
    ("variables", "choice", "coloured"),
    [
        ({"FORCE_COLOR": "1"}, "auto", True),
        ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, "auto", False),
        ({"NO_COLOR": "1"}, "always", True),
        ({"FORCE_COLOR": "1"}, "never", False),
    ],
)
def test_colour_in_a_pipe(variables: dict[str, str], choice: str, coloured: bool) -> None:
    ran = satcheck(*PUSHED, "--color", choice, env=variables)
    assert ("\x1b" in ran.out) == coloured


def test_quiet_prints_nothing_and_writes_the_report(tmp_path: Path) -> None:
    output = tmp_path / "report.json"
    for more in ((), ("-o", str(output))):
        ran = satcheck(*PUSHED, "--quiet", *more)
        assert (ran.code, ran.out, ran.err) == (1, "", "")
    assert json.loads(output.read_text())["summary"]["verdict"] == "fail"


def test_quiet_writes_the_document_that_is_asked_for_on_standard_output() -> None:
    asked = satcheck(*PUSHED, "-q", "-o", "-", "--format", "json")
    assert (asked.code, asked.document["summary"]["verdict"]) == (1, "fail")
    assert satcheck(*PUSHED, "-q", "--format", "json").out == ""
    assert "relation" in satcheck("batch", *PUSHED, "-q", "-o", "-", "--format", "csv").out
    assert satcheck("batch", *PUSHED, "-q").out == ""


def test_ascii_where_the_encoding_has_no_more() -> None:
    ran = satcheck(*PUSHED, env={"PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii"})
    assert ran.code == 1
    assert ran.out.isascii()
    assert "---" in ran.out


def test_names_that_the_encoding_lacks(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "box.obj", tmp_path / "würfel.obj")
    arguments = ("würfel.obj", str(SAMPLES / "cube.off"))
    ascii_only = satcheck(*arguments, cwd=tmp_path, env={"PYTHONIOENCODING": "ascii"})
    assert ascii_only.code == 0
    document = satcheck(
        "--format", "json", *arguments, cwd=tmp_path, env={"PYTHONIOENCODING": "ascii"}
    )
    assert document.document["bodies"][0]["file"] == "würfel.obj"


def in_terminal(*arguments: str, columns: int, variables: Mapping[str, str] | None = None) -> str:
    """What a terminal of that width is sent, standard output and stderr together."""
    import fcntl
    import pty
    import struct
    import termios

    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    process = subprocess.Popen(
        command(*arguments),
        cwd=SAMPLES,
        env=environment({"TERM": "xterm", **(variables or {})}),
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
    )
    os.close(theirs)
    sent = b""
    while True:
        try:
            chunk = os.read(ours, 65536)
        except OSError:  # Linux: the other end was closed
            break
        if not chunk:
            break
        sent += chunk
    os.close(ours)
    process.wait()
    return sent.decode("utf-8")


@on_posix
def test_a_terminal_gets_colour_and_its_width() -> None:
    sent = in_terminal(*PUSHED, columns=60)
    assert "\x1b[1;31m" in sent
    assert "penetrating" in sent


@on_posix
@pytest.mark.parametrize("variables", [{"NO_COLOR": "1"}, {"TERM": "dumb"}])
def test_no_colour_on_request(variables: dict[str, str]) -> None:
    sent = in_terminal(*PUSHED, columns=100, variables=variables)
    assert "\x1b" not in sent


SLOW = (
    "import time\n"
    "import satcheck.audit as door\n"
    "real = door.check\n"
    "def slow(*arguments, **options):\n"
    "    time.sleep(3)\n"
    "    return real(*arguments, **options)\n"
    "door.check = slow\n"
)


@on_posix
def test_long_work_shows_a_bar_to_a_person_only(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(SLOW, encoding="utf-8")
    slow = {"PYTHONPATH": str(tmp_path)}
    assert "checking" in in_terminal(*PUSHED, columns=100, variables=slow)
    assert "checking" not in in_terminal(*PUSHED, columns=100)
    ran = satcheck(*PUSHED, env={**slow, "FORCE_COLOR": "1"})
    assert ran.err == ""
