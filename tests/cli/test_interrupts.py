"""Ctrl-C ends a command whatever it is doing, keeps what is done, and leaves no process."""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from types import ModuleType
from typing import Any

import click
import pytest
from jsonschema import Draft202012Validator

from satcheck import cli
from satcheck.cli.commands.schema import text
from tests.audit.batch.test_slot import PLANTED, marked, on_linux, until
from tests.cli.process import SAMPLES, command, environment

pytestmark = on_linux
# Who ignores Ctrl-C is still there after this.
KILLED = 60
BUSY_SECONDS = 2.0
_TICKS = os.sysconf("SC_CLK_TCK")


class Started:
    """A command in a folder that has a file `begun` as soon as a planted step has begun."""

    def __init__(self, folder: Path, *arguments: str, **more: Any) -> None:
        self.begun = folder / "begun"
        self._mark = f"SATCHECK_TEST={folder}"
        variables = {
            "PYTHONPATH": str(PLANTED),
            "PLANTED_BEGUN": str(self.begun),
            "SATCHECK_TEST": str(folder),
        }
        streams: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **more}
        self.process = subprocess.Popen(
            command(*arguments), cwd=folder, env=environment(variables), text=True, **streams
        )

    def interrupt(self) -> None:
        assert self.process.poll() is None, "it is done before Ctrl-C"
        self.process.send_signal(signal.SIGINT)

    def wait_for_answers(self) -> None:
        """Until it is at a file that hangs, and has the answers of those before it."""
        assert until(self.begun.exists)
        time.sleep(BUSY_SECONDS)

    def interrupted(self) -> tuple[int, str, str]:
        """Exit code, standard output, standard error; no process is left."""
        self.interrupt()
        out, err = self.process.communicate(timeout=KILLED)
        assert until(lambda: not marked(self._mark))
        return self.process.returncode, out, err.lstrip("\n")  # behind the ^C of a terminal

    def processor_seconds(self) -> float:
        words = Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(words[11]) + int(words[12])) / _TICKS

    def kill(self) -> None:
        self.process.kill()
        self.process.communicate()


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Started]]:
    made: list[Started] = []

    def begin(*arguments: str, **more: Any) -> Started:
        made.append(Started(tmp_path, *arguments, **more))
        return made[-1]

    yield begin
    for each in made:
        each.kill()


def sheets(path: Path, seed: int, count: int = 3000) -> None:
    """Triangles in one plane: the core works on two such files until their budget is spent."""
    numbers = random.Random(seed)
    with path.open("w") as file:
        for _ in range(3 * count):
            file.write(f"v {numbers.uniform(-1, 1)!r} {numbers.uniform(-1, 1)!r} 0\n")
        for first in range(1, 3 * count, 3):
            file.write(f"f {first} {first + 1} {first + 2}\n")


def boxes(folder: Path, *names: str) -> None:
    for name in names:
        shutil.copy(SAMPLES / "box.obj", folder / name)


def fill(pipe: int) -> None:
    os.set_blocking(pipe, False)
    with suppress(BlockingIOError):
        while True:
            os.write(pipe, bytes(1 << 12))
    os.set_blocking(pipe, True)


@pytest.mark.parametrize("before", [(), ("resolve",)])
def test_the_core_is_busy(
    start: Callable[..., Started], tmp_path: Path, before: tuple[str, ...]
) -> None:
    sheets(tmp_path / "a.obj", 1)
    sheets(tmp_path / "b.obj", 2)
    run = start(*before, "a.obj", "b.obj")
    assert until(lambda: run.process.poll() is not None or run.processor_seconds() > BUSY_SECONDS)
    assert run.interrupted() == (130, "", "satcheck: interrupted\n")


@pytest.mark.parametrize("before", [(), ("axes",), ("decompose",), ("resolve",)])
def test_the_main_thread_is_deaf(
    start: Callable[..., Started], tmp_path: Path, before: tuple[str, ...]
) -> None:
    boxes(tmp_path, "a.obj", "deaf.obj")
    files = ("deaf.obj",) if before == ("decompose",) else ("a.obj", "deaf.obj")
    run = start(*before, *files)
    assert until(run.begun.exists)
    assert run.interrupted() == (130, "", "satcheck: interrupted\n")


def test_a_child_that_reads_a_file_does_not_hear_it(
    start: Callable[..., Started], tmp_path: Path
) -> None:
    (tmp_path / "hang").mkdir()
    shutil.copy(SAMPLES / "rack.3mf", tmp_path / "hang")
    run = start("hang/rack.3mf")
    assert until(run.begun.exists)
    assert run.interrupted() == (130, "", "satcheck: interrupted\n")


def test_assets_that_are_done_have_their_report(
    start: Callable[..., Started], tmp_path: Path
) -> None:
    boxes(tmp_path, "a.obj", "b.obj", "hang.obj", "later.obj")
    run = start("batch", "a.obj", "b.obj", "hang.obj", "later.obj", "-j", "1")
    run.wait_for_answers()
    code, out, err = run.interrupted()
    assert code == 130
    told = "interrupted: 2 of 4 assets were not checked"
    assert f"warning: {told} [interrupted]" in out
    assert out.splitlines()[-1].startswith("INCOMPLETE: 2 assets: 2 pass ")
    assert err == f"satcheck: {told}\n"


def test_a_report_of_assets_that_are_done_is_no_pass(
    start: Callable[..., Started], tmp_path: Path
) -> None:
    boxes(tmp_path, "a.obj", "hang.obj")
    run = start("batch", "a.obj", "hang.obj", "-o", "report.json")
    run.wait_for_answers()
    code, out, err = run.interrupted()
    assert (code, out) == (130, "")
    assert "interrupted: 1 of 2 assets was not checked" in err
    document = json.loads((tmp_path / "report.json").read_text())
    Draft202012Validator(json.loads(text("assets"))).validate(document)
    assert document["verdict"] == "incomplete"
    assert [asset["file"] for asset in document["assets"]] == ["a.obj"]
    assert [issue["code"] for issue in document["issues"]] == ["interrupted"]


def test_a_gallery_of_what_is_done_waits_for_no_picture(
    start: Callable[..., Started], tmp_path: Path
) -> None:
    boxes(tmp_path, "hang.obj")
    shutil.copy(SAMPLES / "gripper.glb", tmp_path / "a.glb")
    run = start("batch", "a.glb", "hang.obj", "-o", "all.html", "-j", "1")
    run.wait_for_answers()
    code, _, err = run.interrupted()
    assert (code, "interrupted: 1 of 2 assets was not checked" in err) == (130, True)
    page = (tmp_path / "all.html").read_text()
    assert "No picture: interrupted" in page
    assert "<img" not in page


def test_results_that_are_done_are_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Ctrl-C while pictures are drawn."""
    from satcheck.cli import interrupts, worst_findings
    from satcheck.cli.click_classes import satcheck

    def interrupted(*_: object) -> bytes:
        raise KeyboardInterrupt

    monkeypatch.setattr(worst_findings, "_picture", interrupted)
    monkeypatch.setattr(interrupts, "_writing", False)
    page = tmp_path / "all.html"
    call = ["batch", str(SAMPLES / "gripper.glb"), "-o", str(page)]
    assert satcheck.main(call, standalone_mode=False) == 130
    assert "No picture: interrupted" in page.read_text()
    assert "FAIL: 1 asset: 1 fails" in capsys.readouterr().err


def test_without_an_asset_that_is_done_there_is_no_report(
    start: Callable[..., Started], tmp_path: Path
) -> None:
    boxes(tmp_path, "hang.obj")
    run = start("batch", "hang.obj", "-o", "report.json")
    assert until(run.begun.exists)
    assert run.interrupted() == (130, "", "satcheck: interrupted\n")
    assert not (tmp_path / "report.json").exists()


def test_scenes_that_are_done_are_kept(start: Callable[..., Started], tmp_path: Path) -> None:
    boxes(tmp_path, "a.obj", "hang.obj")
    run = start("batch", "a.obj", "hang.obj", "-o", "results.jsonl", "-j", "1")
    run.wait_for_answers()
    code, _, err = run.interrupted()
    assert code == 130
    assert "1 of 2 assets are recorded in results.jsonl.part" in err
    (line,) = (tmp_path / "results.jsonl.part").read_text().splitlines()
    assert json.loads(line)["files"] == ["a.obj"]
    boxes(tmp_path, "b.obj")
    again = start("batch", "a.obj", "b.obj", "-o", "results.jsonl", "--resume")
    _, err = again.process.communicate(timeout=KILLED)
    assert (again.process.returncode, "(1 kept)" in err) == (0, True)


def test_a_second_one_ends_what_is_still_being_written(
    start: Callable[..., Started], tmp_path: Path
) -> None:
    """Nobody reads the pipe that the report goes to."""
    boxes(tmp_path, "a.obj", "hang.obj")
    reading, writing = os.pipe()
    fill(writing)
    run = start("batch", "a.obj", "hang.obj", "-j", "1", stdout=writing)
    run.wait_for_answers()
    run.interrupt()
    assert run.process.stderr is not None
    assert "Ctrl-C again ends at once" in run.process.stderr.readline()
    code, _, err = run.interrupted()
    assert (code, err) == (130, "satcheck: interrupted\n")
    os.close(reading)
    os.close(writing)


def test_where_it_is_ignored_it_stays_ignored(
    start: Callable[..., Started], tmp_path: Path
) -> None:
    """As in a background job of a shell. The child of this command is stopped after seconds."""
    boxes(tmp_path, "a.obj", "hang.obj")

    def ignore() -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)

    options = ("--limit", "scene-seconds=5", "-j", "1")
    run = start("batch", "a.obj", "hang.obj", *options, preexec_fn=ignore)
    assert until(run.begun.exists)
    code, out, err = run.interrupted()
    assert (code, err) == (3, "")
    assert "INCOMPLETE: 2 assets: 1 incomplete (hang.obj), 1 passes (of one body each: " in out


def test_while_the_command_is_still_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    class Interrupted(ModuleType):
        def __getattr__(self, name: str) -> Any:
            raise KeyboardInterrupt

    monkeypatch.setitem(sys.modules, "satcheck.cli.entry", Interrupted("satcheck.cli.entry"))
    monkeypatch.setattr("gc.set_threshold", lambda _: None)
    with pytest.raises(SystemExit) as stop:
        cli.main()
    assert stop.value.code == 130


def test_an_end_of_file_in_the_code_is_no_interrupt(monkeypatch: pytest.MonkeyPatch) -> None:
    """click reports both in the same way."""
    from satcheck.cli import entry

    def ended() -> object:
        raise click.Abort from EOFError("the file is cut off")

    monkeypatch.setattr(entry, "_call", ended)
    assert entry._run() == 2
