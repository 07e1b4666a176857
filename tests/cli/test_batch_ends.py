"""Whatever ends a run of `satcheck batch`, --resume goes on: nothing is lost or done twice."""

from __future__ import annotations

import json
import os
import re
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.audit.batch.test_slot import PLANTED
from tests.cli.process import SAMPLES, command, environment, on_posix

pytestmark = on_posix
COUNT = 12
Start = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Starts `satcheck batch` on scenes that take their time to read."""
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    for number in range(COUNT):
        shutil.copy(SAMPLES / "box.obj", scenes / f"nap{number:02}.obj")
    variables = environment({"PYTHONPATH": str(PLANTED), "PYTHONDONTWRITEBYTECODE": "1"})
    running: list[subprocess.Popen[str]] = []

    def begin(*options: str, **more: Any) -> subprocess.Popen[str]:
        output = () if "-o" in options else ("-o", "results.jsonl")
        words = command("batch", "scenes", *output, "-j", "2", *options)
        pipe = subprocess.PIPE
        run = subprocess.Popen(
            words, cwd=tmp_path, env=variables, stdout=pipe, stderr=pipe, text=True, **more
        )
        running.append(run)
        return run

    yield begin
    for each in running:
        each.kill()
        each.communicate()


def finished(process: subprocess.Popen[str]) -> tuple[int, str]:
    _, err = process.communicate(timeout=120)
    return process.returncode, err


def recorded(folder: Path) -> list[str]:
    """The lines that are complete."""
    part = folder / "results.jsonl.part"
    return part.read_text().split("\n")[:-1] if part.exists() else []


def wait_for_some(folder: Path) -> None:
    for _ in range(1200):
        if len(recorded(folder)) >= 2:
            return
        time.sleep(0.05)
    raise AssertionError("no result has come")


def resumed(start: Start, folder: Path, kept: list[str]) -> None:
    """The other scenes are checked, and the results are those of a run that nothing ends."""
    assert 2 <= len(kept) < COUNT
    code, err = finished(start("--resume"))
    assert code == 0
    assert f"({len(kept)} kept)" in err
    lines = (folder / "results.jsonl").read_text().splitlines()
    assert [json.loads(line)["files"] for line in lines] == [
        [f"scenes/nap{number:02}.obj"] for number in range(COUNT)
    ]
    assert set(kept) <= set(lines)
    assert {place.name for place in folder.iterdir()} == {"results.jsonl", "scenes"}
    interrupted = (folder / "results.jsonl").read_bytes()
    (folder / "results.jsonl").unlink()
    assert finished(start())[0] == 0
    assert (folder / "results.jsonl").read_bytes() == interrupted


def test_ctrl_c(start: Start, tmp_path: Path) -> None:
    run = start()
    wait_for_some(tmp_path)
    run.send_signal(signal.SIGINT)
    code, err = finished(run)
    kept = recorded(tmp_path)
    assert code == 130
    told = re.search(rf"(\d+) of {COUNT} assets are recorded", err)
    # A line may have been written, and not been counted yet.
    assert told is not None
    assert 1 <= int(told[1]) <= len(kept)
    assert "--resume" in err
    assert not (tmp_path / "results.jsonl").exists()
    resumed(start, tmp_path, kept)


def test_a_killed_parent(start: Start, tmp_path: Path) -> None:
    run = start()
    wait_for_some(tmp_path)
    run.kill()
    run.wait()
    with (tmp_path / "results.jsonl.part").open("a") as part:
        part.write('{"schema":"satcheck.result/1","fi')  # half a line
    resumed(start, tmp_path, recorded(tmp_path))


def test_a_full_disk(start: Start, tmp_path: Path) -> None:
    """A limit of the size of files stands for it: Python ignores its signal. It must not keep what
    it compiles meanwhile: no later process could import the beginnings that it would keep."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, resource.RLIM_INFINITY))

    code, err = finished(start(preexec_fn=limit))
    assert code == 2
    assert "cannot-write" in err
    kept = recorded(tmp_path)
    assert f"{len(kept)} of {COUNT} assets are recorded" in err
    resumed(start, tmp_path, kept)


@pytest.mark.skipif(not Path("/sys").exists(), reason="no folder that nobody may write")
def test_a_folder_that_nobody_may_write(start: Start) -> None:
    code, err = finished(start("-o", "/sys/results.jsonl"))
    assert code == 2
    assert "cannot-write" in err


def test_a_folder_that_is_gone(start: Start) -> None:
    code, err = finished(start("-o", f"gone{os.sep}results.jsonl"))
    assert code == 2
    assert "its folder does not exist" in err
