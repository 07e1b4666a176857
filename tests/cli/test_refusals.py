"""The command as a whole process: what it refuses is exit 2 and one clear line, no traceback."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.cli.process import (
    PUSHED,
    SAMPLES,
    VALIDATOR,
    command,
    environment,
    on_posix,
    satcheck,
)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--depth"], "two or more mesh files"),
        (["box.obj"], "one body alone"),
        (["gone.obj"], "gone.obj: no such file"),
        (["--format", "yaml", *PUSHED], "yaml"),
        (["--no-such-option", *PUSHED], "no-such-option"),
        (["--clearance", "5mm", *PUSHED], "no units are declared"),
        (["--clearance", "5mm", *PUSHED], "or state the unit with --units"),
        (["--clearance=-1", *PUSHED], "not a length"),
        (["--jobs", "-1", *PUSHED], "jobs"),
        (["box.obj", "gone.obj"], "gone.obj"),
        (["box.obj", "."], "."),
        (["gone.json"], "gone.json"),
        (["-o", "no/such/folder/report.json", *PUSHED], "folder does not exist"),
        (["batch", "--path", "poses.csv", "arm.urdf"], "No such option '--path'"),
    ],
)
def test_refusals(arguments: list[str], told: str) -> None:
    ran = satcheck(*arguments)
    assert ran.code == 2
    assert told in ran.err
    assert "Traceback" not in ran.err


def test_an_option_raises_the_limit_that_refuses_a_file(tmp_path: Path) -> None:
    file = tmp_path / "large.obj"
    file.write_bytes((SAMPLES / "box.obj").read_bytes() + b"#" * (1 << 20))
    options = ("--exit-zero", "--format", "json", PUSHED[1], str(file))
    refused = satcheck("--limit", "megabytes=1", *options)
    assert refused.code == 2
    assert "raise it with --limit megabytes=N" in refused.err
    read = satcheck("--limit", "megabytes=8", *options)
    assert read.code == 0
    assert read.document["settings"]["megabytes_per_file"] == 8


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux is known to limit address space")
def test_a_limit_that_no_child_process_fits_into_says_which_option_raises_it() -> None:
    ran = satcheck("--limit", "megabytes=4", "rack.3mf", "box.obj")
    assert "needs more than 4 MiB (raise it with --limit megabytes=N)" in ran.err


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


def test_a_failed_input_is_told_once() -> None:
    ran = satcheck("box.obj", "gone.obj")
    line = "satcheck: error: gone.obj: no such file [file-not-found]\n"
    said = "ERROR: no pair could be checked: 1 input could not be used.\n"
    assert (ran.code, ran.out, ran.err) == (2, said, line)
    three = satcheck("box.obj", "cube.off", "gone.obj")
    assert (three.code, three.err) == (2, line)
    assert "gone.obj" not in three.out


def test_a_misspelt_command_gets_a_hint() -> None:
    said = satcheck("confug", "show").err
    assert said.endswith("satcheck: did you mean the command config:\n  satcheck config show\n")
    assert "did you mean" not in satcheck("confug.obj", "box.obj").err


@pytest.mark.parametrize("command", [(), ("suggest",)])
@pytest.mark.parametrize("name", ["report.json", "results.jsonl"])
def test_a_stored_report_is_shown_by_view(
    tmp_path: Path, command: tuple[str, ...], name: str
) -> None:
    satcheck("batch", *PUSHED, "-o", str(tmp_path / name))
    ran = satcheck(*command, name, cwd=tmp_path)
    assert ran.code == 2
    assert f"{name} is a stored report. To show it:\n  satcheck view {name}\n" in ran.err


def test_the_readable_rest_is_still_checked() -> None:
    ran = satcheck("--format", "json", *PUSHED, "gone.obj")
    assert ran.code == 2
    VALIDATOR.validate(ran.document)
    assert "penetrating" in {finding["relation"] for finding in ran.document["findings"]}
    assert [i["severity"] for i in ran.document["issues"] if i["file"] == "gone.obj"] == ["error"]


def test_debug_adds_the_traceback() -> None:
    assert "Traceback" in satcheck("--debug", "-o", "no/such/folder/x.json", *PUSHED).err


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


def test_an_input_is_not_overwritten(tmp_path: Path) -> None:
    cube = (SAMPLES / "cube.off").read_bytes()
    for name in ("a.off", "b.off"):
        (tmp_path / name).write_bytes(cube)
    done = satcheck("a.off", "b.off", "-o", "./b.off", cwd=tmp_path)
    assert done.code == 2
    assert "would overwrite an input" in done.err
    assert (tmp_path / "b.off").read_bytes() == cube


@pytest.mark.parametrize("name", ["x" * 300 + ".json", "x" * 300 + "/report.json"])
def test_a_name_that_is_too_long_is_no_internal_error(tmp_path: Path, name: str) -> None:
    done = satcheck(*PUSHED, "-o", str(tmp_path / name))
    assert done.code == 2
    assert "[cannot-write]" in done.err


@pytest.mark.parametrize("before", [(), ("batch",), ("axes",), ("--package",)])
def test_a_path_that_is_too_long_is_no_internal_error(before: tuple[str, ...]) -> None:
    name = f"a={'x' * 300}" if before == ("--package",) else f"{'x' * 300}.obj"
    done = satcheck(*before, name, "box.obj")
    assert done.code == 2
    assert "internal error" not in done.out + done.err


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names")
def test_a_name_that_is_no_utf8_is_only_a_name(tmp_path: Path) -> None:
    odd = os.fsdecode(b"b\xff.off")
    for name in ("a.off", odd):
        (tmp_path / name).write_bytes((SAMPLES / "cube.off").read_bytes())
    done = satcheck("a.off", odd, "--format", "json", cwd=tmp_path)
    assert done.code == 1
    assert done.document["findings"][0]["relation"] == "coincident"


def test_an_id_that_is_no_unicode_is_only_an_id(tmp_path: Path) -> None:
    box = {"type": "box", "size": [1, 1, 1]}
    bodies = [{"id": "\ud800", "shape": box}, {"id": "b", "shape": box}]
    scene = {"schema": "satcheck.scene/1", "bodies": bodies}
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    done = satcheck("scene.json", "--format", "json", cwd=tmp_path)
    assert done.code == 1
    assert done.document["findings"][0]["relation"] == "coincident"
