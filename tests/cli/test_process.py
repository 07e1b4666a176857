"""The command as a whole process."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from satcheck.cli.report.schema import text
from tests.cli.process import SAMPLES, command, environment, private_cache, satcheck

PUSHED = ("box.obj", "box_pushed.stl")
APART = ("box.obj", "cube.off")
VALIDATOR = Draft202012Validator(json.loads(text()))
on_posix = pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell or terminal")


# --- answers and exit codes -------------------------------------------------------------------


def test_overlap_is_exit_1_and_a_table() -> None:
    ran = satcheck(*PUSHED)
    assert ran.code == 1
    assert "penetrating" in ran.out
    assert "(-1, 0, 0)" in ran.out
    assert ran.out.splitlines()[-1] == "2 bodies, 1 pair: 1 penetrating. Depth 1."
    assert ran.err == ""


def test_no_overlap_is_exit_0() -> None:
    ran = satcheck(*APART)
    assert (ran.code, ran.err) == (0, "")
    assert "No collision." in ran.out


def test_exit_zero_forgives_findings_but_not_failures() -> None:
    assert satcheck("--exit-zero", *PUSHED).code == 0
    assert satcheck("--exit-zero", "box.obj", "gone.obj").code == 2


def test_every_pair_of_many_is_checked() -> None:
    ran = satcheck("--format", "json", "box.obj", "box_pushed.stl", "cube.off", "far_a.obj")
    assert ran.code == 1
    assert ran.document["summary"]["pairs"]["total"] == 6


def test_json_is_one_document_that_follows_the_schema() -> None:
    ran = satcheck("--format", "json", *PUSHED)
    VALIDATOR.validate(ran.document)
    assert ran.document["findings"][0]["depth"] == 1.0
    assert ran.err == ""


def test_without_timings_the_bytes_repeat() -> None:
    once = satcheck("--format", "json", "--no-timings", "--jobs", "1", *PUSHED, "cube.off")
    again = satcheck("--format", "json", "--no-timings", "--jobs", "4", *PUSHED, "cube.off")
    assert once.out == again.out
    assert "microseconds" not in once.out


def test_depth_that_was_not_asked_for_is_null() -> None:
    (finding,) = satcheck("--format", "json", "--no-depth", *PUSHED).document["findings"]
    assert finding["relation"] == "penetrating"
    assert finding["depth"] is None
    assert finding["mtv"] is None


def test_clearance_finds_the_near() -> None:
    ran = satcheck("--clearance", "0.75", *APART)
    assert ran.code == 1
    assert "near" in ran.out
    assert "0.5" in ran.out
    assert satcheck("--clearance", "0.25", *APART).code == 0


def test_tolerance_widens_the_touch_band() -> None:
    (finding,) = satcheck("--format", "json", "--tolerance", "2", *PUSHED).document["findings"]
    assert finding["relation"] == "touching"
    assert finding["exact_relation"] == "penetrating"


def test_explain_tells_the_plan() -> None:
    ran = satcheck("--explain", *PUSHED)
    assert "box against box_pushed: penetrating" in ran.out


@pytest.mark.parametrize(("option", "code"), [("0.4mm", 0), ("0.6mm", 1), ("0.03in", 1)])
def test_units_of_a_scene(option: str, code: int) -> None:
    """Between base and arm there is a gap of 0.5 mm; base and bolt are allowed to meet."""
    ran = satcheck("--format", "json", "--clearance", option, "workcell.json")
    assert ran.code == code
    assert ran.document["units"] == "mm"
    assert ran.document["summary"]["pairs"]["allowed"] == 1


# --- refusals: exit 2, one clear line on stderr, no traceback -----------------------------------


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([], "two or more mesh files"),
        (["box.obj"], "one body alone"),
        (["gone.obj"], "gone.obj: no such file"),
        (["--format", "yaml", *PUSHED], "yaml"),
        (["--no-such-option", *PUSHED], "no-such-option"),
        (["--clearance", "5mm", *PUSHED], "declare no units"),
        (["--clearance=-1", *PUSHED], "not a length"),
        (["--jobs", "-1", *PUSHED], "jobs"),
        (["box.obj", "gone.obj"], "gone.obj"),
        (["box.obj", "."], "."),
        (["gone.json"], "gone.json"),
        (["-o", "no/such/folder/report.json", *PUSHED], "folder does not exist"),
    ],
)
def test_refusals(arguments: list[str], told: str) -> None:
    ran = satcheck(*arguments)
    assert ran.code == 2
    assert told in ran.err
    assert "Traceback" not in ran.err


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("empty.obj", b""),
        ("garbage.stl", b"\x00\xff" * 50),
        ("text.ply", b"this is no mesh\n"),
        ("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
        ("nan.obj", b"v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n"),
        ("broken.glb", b"glTF\x02\x00\x00\x00\xff\xff\xff\x7f"),
        ("scene.json", b'{"schema": "satcheck-scene-1", "bodies": 5}'),
        ("other.json", b"[1, 2"),
        ("unknown.xyz", b"1 2 3\n"),
    ],
)
def test_broken_inputs(tmp_path: Path, name: str, content: bytes) -> None:
    (tmp_path / name).write_bytes(content)
    ran = satcheck(str(tmp_path / name), "box.obj")
    assert ran.code == 2
    assert name in ran.err
    assert "Traceback" not in ran.err + ran.out
    assert "internal" not in ran.err


def test_the_readable_rest_is_still_checked() -> None:
    ran = satcheck("--format", "json", *PUSHED, "gone.obj")
    assert ran.code == 2
    VALIDATOR.validate(ran.document)
    assert "penetrating" in {finding["relation"] for finding in ran.document["findings"]}
    assert [i["severity"] for i in ran.document["issues"] if i["file"] == "gone.obj"] == ["error"]


def test_debug_adds_the_traceback() -> None:
    assert "Traceback" in satcheck("--debug", "-o", "no/such/folder/x.json", *PUSHED).err


# --- where the document goes ------------------------------------------------------------------


@pytest.mark.parametrize(("name", "start"), [("report.json", "{"), ("report.txt", "╭")])
def test_output_file(tmp_path: Path, name: str, start: str) -> None:
    """The ending chooses the format, unless --format does."""
    ran = satcheck("-o", str(tmp_path / name), *PUSHED)
    assert (ran.code, ran.out) == (1, "")
    assert (tmp_path / name).read_text(encoding="utf-8").startswith(start)
    assert "1 penetrating" in ran.err
    assert name in ran.err


def test_output_file_that_cannot_be_written(tmp_path: Path) -> None:
    ran = satcheck("-o", str(tmp_path), *PUSHED)
    assert ran.code == 2
    assert "Traceback" not in ran.err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_an_error() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            command(*APART),
            cwd=SAMPLES,
            env=environment(),
            stdout=full,
            stderr=subprocess.PIPE,
            check=False,
        )
    assert done.returncode == 2
    assert b"cannot write" in done.stderr
    assert b"Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("arguments", "code"), [(PUSHED, 1), (APART, 0), (("--help",), 0), (("schema",), 0)]
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


def test_a_crash_is_exit_2_and_one_line(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(
        "import satcheck.audit as door\n"
        "def broken(*arguments, **options):\n"
        "    raise RuntimeError('the roof\\nfell in')\n"
        "door.check = broken\n",
        encoding="utf-8",
    )
    ran = satcheck(*PUSHED, env={"PYTHONPATH": str(tmp_path)})
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.splitlines() == [
        "satcheck: internal error: RuntimeError: the roof [internal-error] (--debug shows where)"
    ]


def test_a_library_that_exits_is_exit_2(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(
        "import sys\n"
        "import satcheck.audit as door\n"
        "door.check = lambda *arguments, **options: sys.exit(0)\n",
        encoding="utf-8",
    )
    assert satcheck(*PUSHED, env={"PYTHONPATH": str(tmp_path)}).code == 2


@on_posix
def test_ctrl_c_is_130(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(
        "import sys, time\n"
        "import satcheck.audit as door\n"
        "def slow(*arguments, **options):\n"
        "    sys.stderr.write('started\\n')\n"
        "    sys.stderr.flush()\n"
        "    time.sleep(60)\n"
        "door.check = slow\n",
        encoding="utf-8",
    )
    process = subprocess.Popen(
        command(*PUSHED),
        cwd=SAMPLES,
        env=environment({"PYTHONPATH": str(tmp_path)}),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stderr
    assert process.stderr.readline() == "started\n"
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out, err.strip()) == (130, "", "satcheck: interrupted")


# --- how it looks -----------------------------------------------------------------------------


def test_a_pipe_gets_wide_plain_text() -> None:
    for variables in ({}, {"FORCE_COLOR": "1"}, {"NO_COLOR": "1"}, {"COLUMNS": "40"}):
        ran = satcheck(*PUSHED, env=variables)
        assert "\x1b" not in ran.out + ran.err
        assert any("box_pushed" in line and "(-1, 0, 0)" in line for line in ran.out.splitlines())


def test_ascii_where_the_encoding_has_no_more() -> None:
    ran = satcheck(*PUSHED, env={"PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii"})
    assert ran.code == 1
    assert ran.out.isascii()
    assert "+---" in ran.out


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
    "    time.sleep(1.5)\n"
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


# --- help, version, completion ----------------------------------------------------------------


def test_help_advertises_what_exists() -> None:
    ran = satcheck("--help")
    assert ran.code == 0
    assert ran.out.startswith("Usage: satcheck [OPTIONS] A B [C ...]\n")
    for word in ("--clearance", "--accuracy", "Exit codes", "satcheck cache", "_SATCHECK_COMPLETE"):
        assert word in ran.out
    for later in ("batch", "tradeoff", "resolve", "verify", "stability", "view"):
        assert f"satcheck {later}" not in ran.out


def test_usage_errors_name_the_command_as_typed() -> None:
    assert "Try 'satcheck --help' for help" in satcheck("--nonsense").err


def test_version() -> None:
    ran = satcheck("--version")
    assert ran.code == 0
    assert ran.out.startswith("satcheck 0.")


def test_schema_command_prints_the_schema() -> None:
    assert satcheck("schema").document == json.loads(text())


def test_cache_commands(tmp_path: Path) -> None:
    places = private_cache(tmp_path)
    info = satcheck("cache", "info", env=places)
    assert info.code == 0
    assert "0 entries" in info.out
    assert satcheck("cache", "clear", env=places).out == "deleted 0 entries\n"


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_script(shell: str) -> None:
    ran = satcheck(env={"_SATCHECK_COMPLETE": f"{shell}_source"})
    assert ran.code == 0
    assert "_SATCHECK_COMPLETE" in ran.out


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("satcheck --acc", "plain,--accuracy"),
        ("satcheck --accuracy o", "plain,obb"),
        ("satcheck b", "file,b"),
        ("satcheck box.obj --exp", "plain,--explain"),
        ("satcheck ca", "plain,cache"),
        ("satcheck cache i", "plain,info"),
    ],
)
def test_completion(words: str, expected: str) -> None:
    shell = {"_SATCHECK_COMPLETE": "bash_complete", "COMP_WORDS": words}
    ran = satcheck(env={**shell, "COMP_CWORD": str(len(words.split()) - 1)})
    assert expected in ran.out.splitlines()


def test_a_file_named_like_a_command_can_be_checked(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "box.obj", tmp_path / "cache")
    ran = satcheck("./cache", str(SAMPLES / "box.obj"), cwd=tmp_path)
    assert ran.code == 2  # no ending: an unknown format, but a path
    assert "cache" in ran.err
    assert sys.executable not in ran.err
