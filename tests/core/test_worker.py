"""core/worker.py: whatever the child does, the parent gets a reply or a typed error."""

from __future__ import annotations

import copy
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from satcheck.core.worker import (
    Worker,
    WorkerCrashed,
    WorkerError,
    WorkerFailed,
    WorkerNotStarted,
    WorkerOutOfMemory,
    WorkerStopped,
    WorkerTimeout,
    run_isolated,
)

SERVER = "misbehaving_server"
SERVER_FOLDER = Path(__file__).parent / "serve_modules"


@pytest.fixture(autouse=True)
def _server_importable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(SERVER_FOLDER), prepend=os.pathsep)


def ask(request: bytes, *, seconds: float = 20.0, megabytes: int = 512) -> bytes:
    return run_isolated(SERVER, request, seconds=seconds, megabytes=megabytes)


@pytest.mark.parametrize("size", [0, 1, 65_536, 5_000_000])
def test_reply_is_the_payload_at_any_size(size: int) -> None:
    payload = bytes(range(256)) * (size // 256 + 1)
    assert ask(b"echo " + payload[:size]) == payload[:size]


def test_prints_of_any_kind_reach_neither_the_reply_nor_our_output(
    capfd: pytest.CaptureFixture[str],
) -> None:
    assert ask(b"chatter kept") == b"kept"
    assert capfd.readouterr() == ("", "")


def test_abort_is_a_crash_with_signal_and_last_words() -> None:
    with pytest.raises(WorkerCrashed) as caught:
        ask(b"abort")
    error = caught.value
    assert error.code == "worker-crashed"
    assert "last words" in error.stderr_tail
    assert "last words" in error.message
    if os.name == "posix":
        assert error.signal_name == "SIGABRT"
        assert error.exit_code == -signal.SIGABRT


def test_segmentation_fault_is_a_crash() -> None:
    with pytest.raises(WorkerCrashed) as caught:
        ask(b"segfault")
    if os.name == "posix":
        assert caught.value.signal_name == "SIGSEGV"


@pytest.mark.parametrize("code", [0, 7])
def test_leaving_without_a_reply_is_a_crash_whatever_the_exit_code(code: int) -> None:
    with pytest.raises(WorkerCrashed) as caught:
        ask(b"exit %d" % code)
    assert caught.value.exit_code == code
    assert caught.value.signal_name is None


def test_time_limit_kills_the_child(tmp_path: Path) -> None:
    pid_file = tmp_path / "pid"
    started = time.monotonic()
    with pytest.raises(WorkerTimeout) as caught:
        ask(b"record_and_hang " + os.fsencode(pid_file), seconds=1.0)
    assert time.monotonic() - started < 5.0
    assert caught.value.code == "worker-timeout"
    assert not alive(int(pid_file.read_text()))


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux is known to limit address space")
def test_memory_limit_of_the_child() -> None:
    with pytest.raises(WorkerOutOfMemory) as caught:
        ask(b"eat_memory 1024", megabytes=256)
    assert caught.value.code == "worker-out-of-memory"


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux is known to limit address space")
@pytest.mark.parametrize("megabytes", [1, 4, 16])
def test_a_limit_below_what_python_takes_is_out_of_memory(megabytes: int) -> None:
    with pytest.raises(WorkerOutOfMemory):
        ask(b"echo x" * 500_000, megabytes=megabytes)


def test_a_reply_above_the_memory_limit_is_refused_everywhere(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("satcheck.core.worker._BYTES_PER_MEGABYTE", 1 << 10)  # the parent's only
    with pytest.raises(WorkerOutOfMemory):
        ask(b"eat_memory 1", megabytes=256)


def test_a_native_out_of_memory_is_not_reported_as_a_crash() -> None:
    with pytest.raises(WorkerOutOfMemory):
        ask(b"abort_on_memory")


@pytest.mark.parametrize(
    ("request_", "exception_type"),
    [
        (b"raise no such part", "misbehaving_server.RefusedRequest"),
        (b"raise_builtin no such part", "ValueError"),
    ],
)
def test_an_exception_comes_back_with_its_name_and_message(
    request_: bytes, exception_type: str
) -> None:
    with pytest.raises(WorkerFailed) as caught:
        ask(request_)
    assert caught.value.exception_type == exception_type
    assert caught.value.exception_message == "no such part"


def test_a_module_that_breaks_the_contract_is_a_failure() -> None:
    with pytest.raises(WorkerFailed) as caught:
        ask(b"wrong_type x")
    assert caught.value.exception_type == "TypeError"


def test_a_missing_module_is_a_failure() -> None:
    with pytest.raises(WorkerFailed) as caught:
        run_isolated("no_such_module", b"", seconds=20.0, megabytes=256)
    assert caught.value.exception_type == "ModuleNotFoundError"


def test_a_system_that_starts_no_process_is_an_error(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(sys, "executable", str(tmp_path / "no_python"))
    with pytest.raises(WorkerNotStarted) as caught:
        ask(b"echo x")
    assert caught.value.code == "worker-not-started"


@pytest.mark.parametrize("granted", [0, 1, 2])
def test_a_system_that_grants_no_threads_is_an_error(
    monkeypatch: pytest.MonkeyPatch, granted: int
) -> None:
    """Two serve a child, a third one each request."""
    start = threading.Thread.start
    started: list[threading.Thread] = []

    def refuse(thread: threading.Thread) -> None:
        if len(started) == granted:
            raise RuntimeError("can't start new thread")
        started.append(thread)
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", refuse)
    with pytest.raises(WorkerNotStarted, match="can't start new thread"):
        ask(b"echo x")
    for thread in started:
        thread.join(20)
        assert not thread.is_alive()  # the child is gone


def test_one_thread_and_no_working_directory_in_the_child(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert ask(b"environment OMP_NUM_THREADS") == b"1"
    path = ask(b"path").decode().splitlines()
    assert str(tmp_path) not in path
    assert "" not in path


def test_the_child_imports_nothing_heavy() -> None:
    modules = set(ask(b"modules").decode().splitlines())
    assert modules.isdisjoint({"numpy", "trimesh", "coacd", "subprocess"})


def test_the_module_itself_is_cheap_to_import() -> None:
    code = (
        "import sys; import satcheck.core.worker; "
        "assert not {'subprocess', 'numpy', 'importlib.metadata'} & sys.modules.keys()"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_children_of_several_threads_do_not_disturb_each_other() -> None:
    replies: dict[int, bytes] = {}

    def talk(index: int) -> None:
        replies[index] = ask(b"echo %d" % index)

    threads = [threading.Thread(target=talk, args=(index,)) for index in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert replies == {index: b"%d" % index for index in range(6)}


@pytest.mark.skipif(os.name != "posix", reason="sends POSIX signals")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_the_child_does_not_outlive_its_parent(tmp_path: Path, how: signal.Signals) -> None:
    pid_file = tmp_path / "pid"
    code = (
        "import os, sys; from satcheck.core.worker import run_isolated; "
        "request = b'record_and_hang ' + os.fsencode(sys.argv[1]); "
        f"run_isolated({SERVER!r}, request, seconds=60.0, megabytes=256)"
    )
    parent = subprocess.Popen([sys.executable, "-c", code, str(pid_file)], stderr=subprocess.PIPE)
    try:
        wait_until(lambda: pid_file.exists() and pid_file.read_text() != "")
        parent.send_signal(how)
        _, stderr = parent.communicate(timeout=10.0)
    finally:
        parent.kill()
    assert parent.returncode != 0
    if how is signal.SIGINT:
        assert b"KeyboardInterrupt" in stderr
    wait_until(lambda: not alive(int(pid_file.read_text())))


@pytest.mark.parametrize(
    "error",
    [
        WorkerNotStarted("m", "no room"),
        WorkerStopped("m"),
        WorkerTimeout("m", 2.0),
        WorkerOutOfMemory("m", 64),
        WorkerCrashed("m", -11, "a\nb"),
        WorkerFailed("m", "ValueError", "text"),
    ],
)
def test_errors_survive_a_process_boundary(error: WorkerError) -> None:
    for twin in (copy.copy(error), pickle.loads(pickle.dumps(error))):
        assert type(twin) is type(error)
        assert vars(twin) == vars(error)


def alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def wait_until(condition: object, seconds: float = 10.0) -> None:
    assert callable(condition)
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def pid_of(worker: Worker) -> bytes:
    return worker.ask(b"pid", seconds=20.0)


def test_a_worker_keeps_its_child() -> None:
    with Worker(SERVER, megabytes=512) as worker:
        first = pid_of(worker)
        assert worker.ask(b"echo " + b"x" * 5_000_000, seconds=20.0) == b"x" * 5_000_000
        with pytest.raises(WorkerFailed):
            worker.ask(b"raise no", seconds=20.0)
        assert pid_of(worker) == first
    assert pid_is_gone(int(first))


@pytest.mark.parametrize("request_", [b"abort", b"exit 0", b"hang", b"eat_memory 4096"])
def test_a_lost_child_is_replaced(request_: bytes) -> None:
    with Worker(SERVER, megabytes=512) as worker:
        first = pid_of(worker)
        with pytest.raises(WorkerError):
            worker.ask(request_, seconds=2.0)
        assert pid_of(worker) != first


def test_replies_come_in_order_while_more_requests_wait() -> None:
    numbers = [b"%d" % k for k in range(200)]
    with Worker(SERVER, megabytes=512) as worker:
        first = pid_of(worker)
        asked = (b"echo " + number for number in numbers)
        assert list(worker.replies(asked, seconds=20.0, ahead=lambda: 16)) == numbers
        assert pid_of(worker) == first
        assert worker.answered == len(numbers) + 2


@pytest.mark.parametrize(
    ("bad", "error"),
    [
        (b"abort", WorkerCrashed),
        (b"hang", WorkerTimeout),
        (b"eat_memory 4096", WorkerOutOfMemory),
        (b"raise no", WorkerFailed),
    ],
)
def test_the_first_request_without_a_reply_is_to_blame(
    bad: bytes, error: type[WorkerError]
) -> None:
    asked = [b"echo a", b"echo b", bad, b"echo c", b"echo d"]
    replies: list[bytes] = []
    with Worker(SERVER, megabytes=512) as worker:
        with pytest.raises(error):
            replies.extend(worker.replies(asked, seconds=3.0, ahead=lambda: 16))
        assert replies == [b"a", b"b"]
        assert worker.ask(b"echo e", seconds=20.0) == b"e"


def test_what_is_answered_before_a_stop_is_given(tmp_path: Path) -> None:
    """The child has begun the last request, so that the second one has its reply."""
    begun = tmp_path / "pid"
    asked = [b"echo a", b"echo b", b"record_and_hang " + os.fsencode(begun)]
    with Worker(SERVER, megabytes=512) as worker:
        replies = worker.replies(asked, seconds=600.0, ahead=lambda: 3)
        assert next(replies) == b"a"
        wait_until(begun.exists)
        worker.stop()
        assert next(replies) == b"b"
        with pytest.raises(WorkerStopped):
            next(replies)


def test_an_iteration_that_is_left_leaves_no_reply_behind() -> None:
    with Worker(SERVER, megabytes=512) as worker:
        for reply in worker.replies([b"echo a", b"echo b"], seconds=20.0, ahead=lambda: 2):
            assert reply == b"a"
            break
        assert worker.ask(b"echo c", seconds=20.0) == b"c"


def test_threads_take_turns() -> None:
    with Worker(SERVER, megabytes=512) as worker:
        replies: list[bytes] = []
        threads = [
            threading.Thread(
                target=lambda k=k: replies.append(worker.ask(b"echo %d" % k, seconds=20.0))
            )
            for k in range(8)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert sorted(replies) == [b"%d" % k for k in range(8)]


def test_a_stop_ends_a_request_that_runs(tmp_path: Path) -> None:
    pid_file = tmp_path / "pid"
    errors: list[WorkerError] = []

    def ask_to_hang() -> None:
        try:
            worker.ask(b"record_and_hang " + os.fsencode(pid_file), seconds=600.0)
        except WorkerError as error:
            errors.append(error)

    with Worker(SERVER, megabytes=512) as worker:
        thread = threading.Thread(target=ask_to_hang)
        thread.start()
        wait_until(lambda: pid_file.exists() and pid_file.read_text() != "")
        worker.stop()
        thread.join()
        assert [type(error) for error in errors] == [WorkerStopped]
        assert pid_is_gone(int(pid_file.read_text()))
        with pytest.raises(WorkerStopped):
            worker.ask(b"echo more", seconds=20.0)


def test_a_stop_while_the_child_starts_ends_the_request(monkeypatch: pytest.MonkeyPatch) -> None:
    """stop() sees no child yet."""
    start = subprocess.Popen
    started: list[subprocess.Popen[bytes]] = []

    def stopped_meanwhile(*words: Any, **options: Any) -> subprocess.Popen[bytes]:
        worker.stop()
        started.append(start(*words, **options))
        return started[-1]

    with Worker(SERVER, megabytes=512) as worker:
        monkeypatch.setattr(subprocess, "Popen", stopped_meanwhile)
        with pytest.raises(WorkerStopped, match="was stopped by the process that uses it"):
            worker.ask(b"hang", seconds=600.0)
    assert started[0].returncode is not None


def pid_is_gone(pid: int) -> bool:
    if os.name != "posix":
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    return False
