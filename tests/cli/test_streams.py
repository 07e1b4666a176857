"""The command as a whole process: where the document goes."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.cli.process import (
    APART,
    PUSHED,
    SAMPLES,
    VALIDATOR,
    command,
    environment,
    on_posix,
    satcheck,
)


@pytest.mark.parametrize(("name", "start"), [("report.json", "{"), ("report.txt", "A    B  ")])
def test_output_file(tmp_path: Path, name: str, start: str) -> None:
    """The ending chooses the format, unless --format does."""
    ran = satcheck("-o", str(tmp_path / name), *PUSHED)
    assert (ran.code, ran.out) == (1, "")
    assert (tmp_path / name).read_text(encoding="utf-8").startswith(start)
    assert "1 penetrating" in ran.err
    assert name in ran.err


@pytest.mark.parametrize("ending", ["svg", "xlsx", "jsno"])
def test_a_name_that_no_report_has_is_refused(tmp_path: Path, ending: str) -> None:
    page = tmp_path / f"report.{ending}"
    ran = satcheck("-o", str(page), *PUSHED)
    assert ran.code == 2
    assert f"report.{ending}: this command writes .txt, .json" in ran.err
    assert not page.exists()
    assert satcheck("--format", "table", "-o", str(page), *PUSHED).code == 1
    assert page.read_text(encoding="utf-8").startswith("A    B  ")


def test_warnings_do_not_vanish_with_the_output(tmp_path: Path) -> None:
    ran = satcheck("-o", str(tmp_path / "report.json"), "box.obj", "inside_out.stl")
    assert "satcheck: warning: inside_out: " in ran.err


def test_a_dash_is_standard_output() -> None:
    ran = satcheck("--format", "json", "-o", "-", *PUSHED)
    assert ran.document["summary"]["pairs"]["total"] == 1
    assert ran.err == ""


def test_output_file_that_cannot_be_written(tmp_path: Path) -> None:
    ran = satcheck("-o", str(tmp_path), *PUSHED)
    assert ran.code == 2
    assert "Traceback" not in ran.err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize(
    "arguments",
    [
        APART,
        ("--format", "json", *APART),
        ("schema",),
        ("config", "show"),
        ("--help",),
        ("resolve", "-h"),
        ("config", "show", "--help"),
        ("schema", "-h"),
        ("--version",),
        ("bash_source",),
    ],
)
def test_a_full_disk_is_an_error(arguments: tuple[str, ...]) -> None:
    completes = arguments == ("bash_source",)
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            command(*(() if completes else arguments)),
            cwd=SAMPLES,
            env=environment({"_SATCHECK_COMPLETE": "bash_source"} if completes else None),
            stdout=full,
            stderr=subprocess.PIPE,
            check=False,
        )
    assert done.returncode == 2
    said = b"satcheck: error: standard output: cannot write: No space left on device [cannot-write]"
    assert done.stderr.splitlines() == [said]


@pytest.mark.parametrize(
    ("arguments", "code"),
    [(PUSHED, 1), (APART, 0), (("--help",), 0), (("config", "-h"), 0), (("schema",), 0)],
)
def test_a_reader_that_leaves_early_changes_nothing(arguments: tuple[str, ...], code: int) -> None:
    process = subprocess.Popen(
        command(*arguments),
        cwd=SAMPLES,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdout
    assert process.stderr
    process.stdout.close()
    error = process.stderr.read()
    process.stderr.close()
    assert process.wait() == code
    assert error == b""


@on_posix
def test_a_closed_standard_output_is_no_crash() -> None:
    line = " ".join(f"'{word}'" for word in command(*PUSHED)) + " >&-"
    done = subprocess.run(
        ["/bin/sh", "-c", line], cwd=SAMPLES, env=environment(), capture_output=True, check=False
    )
    assert done.returncode == 1
    assert b"Traceback" not in done.stderr


@on_posix
def test_a_document_that_a_program_waits_for_is_not_lost_in_silence() -> None:
    line = " ".join(f"'{word}'" for word in command("--format", "json", *PUSHED)) + " >&-"
    done = subprocess.run(
        ["/bin/sh", "-c", line], cwd=SAMPLES, env=environment(), capture_output=True, check=False
    )
    assert (done.returncode, b"[cannot-write]" in done.stderr) == (2, True)


def test_what_others_print_stays_out_of_the_document(tmp_path: Path) -> None:
    """A chatty library: Python prints and writes to descriptor 1 during the check and at exit."""
    (tmp_path / "sitecustomize.py").write_text(
        "import atexit, os\n"
        "import satcheck.audit.check as room\n"
        "import satcheck.audit as door\n"
        "quiet = door.check\n"
        "def chatty(*arguments, **options):\n"
        "    print('chatter from Python')\n"
        "    os.write(1, b'chatter from native code\\n')\n"
        "    atexit.register(os.write, 1, b'chatter at exit\\n')\n"
        "    return quiet(*arguments, **options)\n"
        "door.check = chatty\n",
        encoding="utf-8",
    )
    ran = satcheck("--format", "json", *PUSHED, env={"PYTHONPATH": str(tmp_path)})
    VALIDATOR.validate(ran.document)
    assert ran.err.count("chatter") == 3
