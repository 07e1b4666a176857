"""A slot answers for every world, whatever a world does to its process."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from threading import Event, Thread
from typing import Any

import pytest

from satcheck.audit.batch import local
from satcheck.audit.batch import slot as slot_module
from satcheck.audit.batch.local import check_locally
from satcheck.audit.batch.options import CheckOptions, Limits, Pace, World
from satcheck.audit.batch.results import ResultsFile
from satcheck.audit.batch.run import run
from satcheck.audit.batch.slot import Slot
from satcheck.audit.batch.slot_server import Answer
from satcheck.core import worker
from satcheck.core.worker_errors import WorkerNotStarted
from satcheck.report.assets import LEFT_OUT
from tests.cli.process import SAMPLES, command, environment, on_posix

pytestmark = on_posix
PLANTED = Path(__file__).parent / "planted"
PATIENT = Limits(seconds=100.0, megabytes=2048)
QUICK = Limits(seconds=3.0, megabytes=2048)


class Clock:
    """The time, which jumps beyond every limit when a child begins to hang: nobody waits for it,
    and a machine that is slow has time to start a child."""

    def __init__(self, begun: Path) -> None:
        self._begun = begun
        self._ahead = 0.0

    def monotonic(self) -> float:
        if self._begun.exists():
            self._begun.unlink()
            self._ahead += 2.0 * PATIENT.seconds
        return time.monotonic() + self._ahead


@pytest.fixture(autouse=True)
def _planted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PYTHONPATH", environment({"PYTHONPATH": str(PLANTED)})["PYTHONPATH"])
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def _clock(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    begun = tmp_path / "begun"
    monkeypatch.setenv("PLANTED_BEGUN", str(begun))
    clock = Clock(begun)
    monkeypatch.setattr(slot_module, "time", clock)
    monkeypatch.setattr(worker, "time", clock)


@pytest.fixture
def slot() -> Iterator[Callable[[Limits], Slot]]:
    made: list[Slot] = []

    def make(limits: Limits) -> Slot:
        made.append(Slot(CheckOptions(), limits))
        return made[-1]

    yield make
    for each in made:
        each.close()


def scene(name: str, *bodies: tuple[str, str]) -> World:
    """bodies: their ids and mesh files, which are copies of one box at one place."""
    text = 'schema = "satcheck.scene/1"\n'
    for id_, mesh in bodies:
        shutil.copy(SAMPLES / "box.obj", mesh)
        text += f'[[bodies]]\nid = "{id_}"\nmesh = "{mesh}"\n'
    Path(name).write_text(text)
    return (name,)


def good(name: str = "good.toml") -> World:
    return scene(name, ("a", "a.obj"), ("b", "b.obj"))


def checked(slot: Slot, *worlds: World) -> list[Any]:
    answers = list(slot.check(worlds))
    assert [answer.world for answer in answers] == list(worlds)
    return [json.loads(answer.line) for answer in answers]


def relations(result: Any) -> dict[tuple[str, str], str]:
    return {(each["a"], each["b"]): each["relation"] for each in result["report"]["findings"]}


def issues(result: Any) -> list[tuple[str, str, str]]:
    return [
        (issue["code"], issue["severity"], issue["message"]) for issue in result["report"]["issues"]
    ]


@pytest.mark.parametrize(
    ("word", "code", "how"),
    [
        ("segfault", "worker-crashed", "died (SIGSEGV)"),
        ("abort", "worker-crashed", "died (SIGABRT)"),
        ("hang", "worker-timeout", "was stopped after 100 s"),
        ("bomb", "worker-out-of-memory", "needed more than 2048 MiB"),
    ],
)
@pytest.mark.parametrize("what", ["file", "pair"])
@pytest.mark.usefixtures("_clock")
def test_the_culprit_is_named_and_the_others_are_checked(
    slot: Callable[[Limits], Slot], word: str, code: str, how: str, what: str
) -> None:
    mesh, id_ = (f"{word}.obj", "z") if what == "file" else ("z.obj", word)
    bad = scene("bad.toml", (id_, mesh), ("b", "b.obj"), ("c", "c.obj"))
    before, result, after = checked(slot(PATIENT), good(), bad, good("more.toml"))
    assert [before["verdict"], result["verdict"], after["verdict"]] == ["fail"] * 3
    assert relations(result) == {
        (id_, "b"): "indeterminate",
        (id_, "c"): "indeterminate",
        ("b", "c"): "coincident",
    }
    said = {
        "file": {f"{mesh}: the process that read it {how}"},
        "pair": {f"{id_} and {b}: the process that checked this pair {how}" for b in "bc"},
    }[what]
    assert {text for kind, severity, text in issues(result) if kind == code} == said
    assert all(severity != "error" for _, severity, _ in issues(result))
    assert before["key"]


@pytest.mark.parametrize("what", ["file", "pair"])
def test_an_answer_without_a_culprit_holds_as_long_as_the_limits(
    slot: Callable[[Limits], Slot], what: str
) -> None:
    mesh, id_ = ("abort.obj", "z") if what == "file" else ("z.obj", "abort")
    bad = scene("bad.toml", (id_, mesh), ("b", "b.obj"))

    def kept(limits: Limits) -> int:
        made = slot(limits)

        def engine(worlds: Sequence[World]) -> Generator[list[Answer]]:
            yield list(made.check(worlds))

        with ResultsFile(Path("results.jsonl")) as results:
            return run([bad], CheckOptions(), limits, engine, results, lambda _: None).kept

    more = Limits(PATIENT.seconds, 2 * PATIENT.megabytes)
    assert [kept(PATIENT), kept(PATIENT), kept(more), kept(more)] == [0, 1, 0, 1]
    shutil.copy(SAMPLES / "box_pushed.stl", mesh)
    assert kept(more) == 0


def test_a_scene_with_nothing_but_a_culprit_is_incomplete(slot: Callable[[Limits], Slot]) -> None:
    shutil.copy(SAMPLES / "box.obj", "abort.obj")
    (result,) = checked(slot(PATIENT), ("abort.obj",))
    assert result["verdict"] == "incomplete"


def test_a_culprit_whose_pairs_are_allowed_is_no_pass(slot: Callable[[Limits], Slot]) -> None:
    bad = scene("bad.toml", ("a", "abort.obj"), ("b", "b.obj"))
    with Path("bad.toml").open("a") as file:
        file.write('[[rules]]\na = "*"\nb = "*"\nallowed = true\nreason = "known"\n')
    (result,) = checked(slot(PATIENT), bad)
    assert result["verdict"] == "incomplete"


def test_too_many_culprits_are_one_answer(slot: Callable[[Limits], Slot]) -> None:
    bad = scene("bad.toml", *((f"b{n}", f"abort{n}.obj") for n in range(5)))
    (result,) = checked(slot(PATIENT), bad)
    assert result["verdict"] == "incomplete"
    assert issues(result) == [
        ("worker-crashed", "warning", "bad.toml: the process that checked it died (SIGABRT)")
    ]


def test_no_step_is_to_blame_for_many_that_take_long(slot: Callable[[Limits], Slot]) -> None:
    bodies = [(f"b{n}", f"nap{n}.obj") for n in range(9)]
    (result,) = checked(slot(QUICK), scene("slow.toml", *bodies))
    said = "slow.toml: the process that checked it was stopped after 3 s"
    assert issues(result) == [("worker-timeout", "warning", said)]


def test_a_careful_check_has_the_same_answer(slot: Callable[[Limits], Slot]) -> None:
    worlds = [("workcell.json",), ("cell.toml",), ("rack.3mf",), ("arm.urdf",)]
    os.chdir(SAMPLES)
    plain = checked(slot(PATIENT), *worlds)
    careful = [slot(PATIENT)._alone(world) for world in worlds]
    assert [json.loads(answer.line) for answer in careful] == plain


def test_a_process_that_a_user_kills_costs_no_answer(slot: Callable[[Limits], Slot]) -> None:
    one = slot(PATIENT)
    checked(one, good())
    child = one._worker._child
    assert child is not None
    os.kill(child._process.pid, signal.SIGKILL)
    (result,) = checked(one, good())
    assert result["verdict"] == "fail"
    assert result["key"]


def test_a_system_without_processes_is_an_error(
    slot: Callable[[Limits], Slot], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise BlockingIOError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(subprocess, "Popen", refuse)
    with pytest.raises(WorkerNotStarted, match="no process could be started"):
        list(slot(PATIENT).check([good()]))


def test_a_stop_during_a_careful_check_ends_it(slot: Callable[[Limits], Slot]) -> None:
    """The first world ends the process, so that each is then checked alone; the second hangs."""
    worlds = [
        scene(f"{word}.toml", ("a", f"{word}.obj"), ("b", "b.obj")) for word in ("abort", "hang")
    ]
    made = slot(Limits(seconds=600.0, megabytes=2048))
    answered: list[World] = []
    first, ended = Event(), Event()

    def check() -> None:
        for answer in made.check(worlds):
            answered.append(answer.world)
            first.set()
        ended.set()

    Thread(target=check, daemon=True).start()
    assert first.wait(100)
    made.stop()
    assert ended.wait(100)
    assert answered == worlds[:1]


def marked(mark: str) -> list[int]:
    """The processes with this variable in their environment."""
    found = []
    for place in Path("/proc").iterdir():
        with suppress(OSError):  # it has ended, or is somebody else's
            if place.name.isdigit() and mark.encode() in (place / "environ").read_bytes():
                found.append(int(place.name))
    return found


def until(holds: Callable[[], bool]) -> bool:
    """Whether it comes to hold. The time is that of a machine that has stopped."""
    for _ in range(600):
        if holds():
            return True
        time.sleep(0.1)
    return False


on_linux = pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="lists processes")


@pytest.fixture
def batch(tmp_path: Path) -> Iterator[Callable[[str], tuple[subprocess.Popen[bytes], str]]]:
    """Starts `satcheck batch FILE`. Gives its process, and a mark that its environment has."""
    started = []

    def start(file: str) -> tuple[subprocess.Popen[bytes], str]:
        mark = f"SATCHECK_TEST={tmp_path}"
        variables = environment({"PYTHONPATH": str(PLANTED), "SATCHECK_TEST": str(tmp_path)})
        options = ["-o", "results.jsonl", "--limit", "scene-seconds=4"]
        started.append(subprocess.Popen(command("batch", file, *options), env=variables))
        return started[-1], mark

    yield start
    for each in started:
        each.kill()
        each.wait()


@on_linux
def test_no_process_outlives_a_killed_parent_in_native_code(
    batch: Callable[[str], tuple[subprocess.Popen[bytes], str]],
) -> None:
    shutil.copy(SAMPLES / "box.obj", "hang.obj")
    parent, mark = batch("hang.obj")
    assert until(lambda: len(marked(mark)) == 2)
    parent.kill()
    parent.wait()
    assert until(lambda: not marked(mark))


@on_linux
@pytest.mark.parametrize("victim", ["parent", "worker"])
def test_no_child_of_a_worker_outlives_it(
    batch: Callable[[str], tuple[subprocess.Popen[bytes], str]], victim: str
) -> None:
    """The reader of a 3MF file is a child of the worker, and hangs."""
    Path("hang").mkdir()
    shutil.copy(SAMPLES / "rack.3mf", "hang")
    parent, mark = batch("hang/rack.3mf")
    assert until(lambda: len(marked(mark)) == 3)
    _, worker, reader = sorted(marked(mark))
    if victim == "parent":
        parent.kill()
        parent.wait()
    else:
        os.kill(worker, signal.SIGKILL)
    assert until(lambda: reader not in marked(mark))
    assert until(lambda: not marked(mark))


def test_worlds_behind_a_culprit_are_sent_again(
    slot: Callable[[Limits], Slot], monkeypatch: pytest.MonkeyPatch
) -> None:
    class Eager(Pace):
        def __init__(self, largest: int) -> None:
            super().__init__(largest)
            self.size = largest

    monkeypatch.setattr(slot_module, "Pace", Eager)
    words = ["a", "abort", "b", "segfault", "c"]
    worlds = [scene(f"{word}.toml", ("a", f"{word}.obj"), ("b", "box.obj")) for word in words]
    results = checked(slot(PATIENT), *worlds)
    named = [[text for code, _, text in issues(each) if code in LEFT_OUT] for each in results]
    assert [bool(texts) for texts in named] == [False, True, False, True, False]
    assert all(result["key"] for result in results)


def test_an_interrupt_takes_what_processes_have_given(monkeypatch: pytest.MonkeyPatch) -> None:
    """It comes before the first look for answers, when all but the last world have theirs."""
    worlds = [good(f"{number}.toml") for number in range(8)] + [
        scene("hang.toml", ("a", "hang.obj"), ("b", "box.obj"))
    ]
    begun = Path("begun")
    monkeypatch.setenv("PLANTED_BEGUN", str(begun.resolve()))

    def interrupted(_: object) -> list[Answer]:
        assert until(begun.exists)
        raise KeyboardInterrupt

    monkeypatch.setattr(local._Slots, "answers", interrupted)
    coming = check_locally(worlds, CheckOptions(), Limits(seconds=600.0), slots=1)
    answers = next(coming)
    assert [answer.world for answer in answers] == worlds[:-1]
    with pytest.raises(KeyboardInterrupt):
        next(coming)


def test_a_mesh_of_many_scenes_is_split_once(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Slots that need its parts at the same time wait for the first one."""
    splits = tmp_path / "splits"
    splits.mkdir()
    monkeypatch.setenv("PLANTED_SPLITS", str(splits))
    monkeypatch.setenv("SATCHECK_CACHE_DIR", str(tmp_path / "cache"))
    shutil.copy(SAMPLES / "l_bracket.obj", "l_bracket.obj")
    shutil.copy(SAMPLES / "box.obj", "box.obj")
    for number in range(6):
        Path(f"s{number}.toml").write_text(
            'schema = "satcheck.scene/1"\n[[bodies]]\nid = "a"\nmesh = "l_bracket.obj"\n'
            f'[[bodies]]\nid = "b"\nmesh = "box.obj"\nposition = [{number / 10}, 0, 0]\n'
        )
    worlds = [(f"s{number}.toml",) for number in range(6)]
    options = CheckOptions(settings={"accuracy": "parts"})
    answers = [
        answer for some in check_locally(worlds, options, PATIENT, slots=3) for answer in some
    ]
    assert len(answers) == len(worlds)
    assert all(json.loads(answer.line)["report"]["bodies"][0]["parts"] for answer in answers)
    assert len(list(splits.iterdir())) == 1
