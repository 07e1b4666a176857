"""A system that grants a process no thread beside its first one: slower, with the same answers."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.cli.process import SAMPLES, SECONDS, environment, satcheck

# Threads get stacks larger than any address space, so that none can be started.
WITHOUT_THREADS = """
import ctypes, runpy, sys, threading
library = ctypes.CDLL(None)
attributes = ctypes.create_string_buffer(256)
library.pthread_attr_init(attributes)
library.pthread_attr_setstacksize(attributes, ctypes.c_size_t(1 << 60))
if not hasattr(library, "pthread_setattr_default_np"):
    sys.exit(77)
library.pthread_setattr_default_np(attributes)
try:
    threading.Thread(target=int).start()
except RuntimeError:
    sys.argv[0] = "satcheck"
    runpy.run_module("satcheck.cli", run_name="__main__")
"""
NOT_THIS_SYSTEM = 77
# Ten pairs of these overlap and take a search for their depth: enough for a pool of threads.
CONCAVE = ("kettle.obj", "ring.glb", "snowflake.obj", "l_bracket.obj", "link_a.ply", "rod.stl")


def without_threads(*arguments: str) -> tuple[int, str]:
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_THREADS, *arguments],
        cwd=SAMPLES,
        env=environment({"OPENBLAS_NUM_THREADS": "1"}),
        capture_output=True,
        timeout=SECONDS,
        check=False,
    )
    if done.returncode == NOT_THIS_SYSTEM:
        pytest.skip("only glibc lets a process refuse itself threads")
    return done.returncode, done.stdout.decode("utf-8")


@pytest.mark.skipif(sys.platform != "linux", reason="a way to refuse threads that glibc has")
@pytest.mark.parametrize(
    "arguments",
    [
        ("--depth", "--width", "0.5", "--no-timings", "--format", "json", *CONCAVE),
        ("resolve", "--format", "json", "box.obj", "box_pushed.stl", "rod.stl"),
    ],
)
def test_no_threads_change_no_answer(arguments: tuple[str, ...]) -> None:
    usual = satcheck(*arguments, "--jobs", "2")
    assert usual.code in (0, 1)
    assert without_threads(*arguments, "--jobs", "2") == (usual.code, usual.out)
