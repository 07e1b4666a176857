"""What `-o` writes: all of it or nothing, where it belongs, as the file there was."""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from satcheck.report.atomic_file import replace_file
from tests.cli.process import PUSHED, SAMPLES, SECONDS, command, environment, on_posix, satcheck

OLD = b'{"an older": "report"}\n'
as_a_user = pytest.mark.skipif(
    os.name != "posix" or os.getuid() == 0, reason="root may write everything"
)
LIMIT = 200  # bytes of a file: less than any of the documents has
WRITERS: dict[str, tuple[tuple[str, ...], str]] = {
    "check": (("-o", "{}", *PUSHED), "out.json"),
    "table": (("-o", "{}", "--explain", *PUSHED), "out.txt"),
    "samples": (("-o", "{}", "arm.urdf", "--sample", "2"), "out.json"),
    "resolve": (("resolve", "-o", "{}", *PUSHED), "out.json"),
    "scene": (("resolve", "-o", "{}", *PUSHED, "--allow-outside"), "out.json"),
    "suggest": (("suggest", "-o", "{}", "rack.3mf"), "out.toml"),
    "tradeoff": (("tradeoff", "-o", "{}", "--limit", "run-seconds=1", *PUSHED), "out.json"),
    "plot": (("tradeoff", "--plot", "{}", "--limit", "run-seconds=1", *PUSHED), "out.svg"),
}


def short_of_disk() -> None:
    """No file may grow beyond the limit, as on a disk that is full. Python must not keep what it
    compiles meanwhile: it would keep the beginnings, and no later process could import them."""
    import resource

    resource.setrlimit(resource.RLIMIT_FSIZE, (LIMIT, LIMIT))


@on_posix
@pytest.mark.parametrize("writer", WRITERS)
def test_a_full_disk_leaves_the_older_file(tmp_path: Path, writer: str) -> None:
    arguments, name = WRITERS[writer]
    out = tmp_path / name
    out.write_bytes(OLD)
    done = subprocess.run(
        command(*(word.replace("{}", str(out)) for word in arguments)),
        cwd=SAMPLES,
        env=environment({"PYTHONDONTWRITEBYTECODE": "1"}),
        capture_output=True,
        timeout=SECONDS,
        check=False,
        preexec_fn=short_of_disk,
    )
    assert done.returncode == 2
    assert b"cannot write: File too large [cannot-write]" in done.stderr
    assert b"Traceback" not in done.stderr
    assert out.read_bytes() == OLD
    assert names_in(tmp_path) == [name]


def names_in(folder: Path) -> list[str]:
    return [file.name for file in folder.iterdir()]


def broken_off() -> Iterator[bytes]:
    yield b"half of "
    raise KeyboardInterrupt


def test_an_interrupted_write_leaves_the_older_file(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    out.write_bytes(OLD)
    with pytest.raises(KeyboardInterrupt):
        replace_file(out, broken_off())
    assert out.read_bytes() == OLD
    assert names_in(tmp_path) == ["out.json"]


def test_a_new_file_has_the_permissions_of_any(tmp_path: Path) -> None:
    (tmp_path / "other").touch()
    replace_file(tmp_path / "out", [b"new", b" content"])
    assert (tmp_path / "out").read_bytes() == b"new content"
    assert (tmp_path / "out").stat().st_mode == (tmp_path / "other").stat().st_mode


@on_posix
def test_permissions_stay(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    out.write_bytes(OLD)
    out.chmod(0o640)
    replace_file(out, [b"new"])
    assert stat.S_IMODE(out.stat().st_mode) == 0o640


@as_a_user
def test_a_file_that_is_not_to_be_written_is_refused(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    out.write_bytes(OLD)
    out.chmod(0o400)
    with pytest.raises(PermissionError):
        replace_file(out, [b"new"])
    assert out.read_bytes() == OLD


@as_a_user
def test_a_folder_that_takes_no_new_file_is_written_in(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    out.write_bytes(OLD)
    tmp_path.chmod(0o500)
    try:
        replace_file(out, [b"new"])
    finally:
        tmp_path.chmod(0o700)
    assert out.read_bytes() == b"new"


@on_posix
def test_a_link_stays_one(tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    out, real = tmp_path / "out.json", tmp_path / "far" / "real.json"
    out.symlink_to(Path("far") / "real.json")
    replace_file(out, [b"first"])  # the file is not there yet
    replace_file(out, [b"second"])
    assert out.is_symlink()
    assert real.read_bytes() == b"second"
    assert names_in(tmp_path / "far") == ["real.json"]
    endless = tmp_path / "endless"
    endless.symlink_to("endless")
    with pytest.raises(OSError, match="symbolic links"):
        replace_file(endless, [b"third"])


@on_posix
def test_a_pipe_is_written_to(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read: list[bytes] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    replace_file(pipe, [b"through ", b"the pipe"])
    reader.join()
    assert read == [b"through the pipe"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)


@pytest.mark.skipif(sys.platform != "linux", reason="needs /dev/stdout")
@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
def test_standard_output_by_its_name(tmp_path: Path, name: str) -> None:
    ran = satcheck("--format", "json", "-o", name, *PUSHED)
    assert ran.document["schema"] == "satcheck.report/1"
    link = tmp_path / "link.json"
    link.symlink_to(name)
    assert satcheck("-o", str(link), *PUSHED).document["schema"] == "satcheck.report/1"
    with (tmp_path / "log").open("w") as log:
        log.write("before\n")
        log.flush()
        arguments = command("--format", "json", "-o", name, *PUSHED)
        subprocess.run(arguments, cwd=SAMPLES, env=environment(), stdout=log, check=False)
        log.write("after\n")
    text = (tmp_path / "log").read_text(encoding="utf-8")
    assert text.startswith("before\n{")
    assert "}\nafter\n" in text
    assert json.loads(text.removeprefix("before\n").partition("after")[0])


@pytest.mark.skipif(sys.platform != "linux", reason="needs /dev/stderr")
@pytest.mark.parametrize("name", ["/dev/stderr", "/dev/fd/2"])
def test_what_is_open_already_is_not_cut_off(tmp_path: Path, name: str) -> None:
    with (tmp_path / "log").open("w") as log:
        log.write("before\n")
        log.flush()
        arguments = command("--format", "json", "-o", name, *PUSHED)
        subprocess.run(arguments, cwd=SAMPLES, env=environment(), stderr=log, check=False)
    text = (tmp_path / "log").read_text(encoding="utf-8")
    document, _, last = text.removeprefix("before\n").rpartition("}\n")
    assert json.loads(document + "}")["schema"] == "satcheck.report/1"
    said = "FAIL: box and box_pushed overlap (thickness 1, 1 to pull apart)."
    assert last == f"2 bodies, 1 pair: 1 penetrating.\n{said} Report: {name}\n"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_device_that_is_full() -> None:
    ran = satcheck("--format", "json", "-o", "/dev/full", *PUSHED)
    assert ran.code == 2
    assert "/dev/full: cannot write: No space left on device" in ran.err


@on_posix
def test_a_link_out_of_its_folder_is_not_followed(tmp_path: Path) -> None:
    outside = tmp_path / "outside.json"
    outside.write_bytes(OLD)
    inside = tmp_path / "work"
    inside.mkdir()
    (inside / "report.json").symlink_to(outside)
    with pytest.raises(PermissionError, match="out of its folder"):
        replace_file(inside / "report.json", [b"{}"])
    assert outside.read_bytes() == OLD
