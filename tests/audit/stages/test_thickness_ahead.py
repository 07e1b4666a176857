"""The two searches of the only pair, side by side."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from threading import Event, Thread, current_thread, main_thread
from typing import Any

import pytest

from satcheck import core
from satcheck.audit import Finding, Settings, check
from satcheck.scene import load_scene

SAMPLES = Path(__file__).parents[3] / "sample_meshes"
# Ends a wait that would be for ever.
LONG = 60.0

Search = Callable[..., Any]


def found(*names: str, jobs: int = 2) -> list[Finding]:
    scene = load_scene([SAMPLES / name for name in names])
    return list(check(scene, Settings(depth=True, jobs=jobs)).findings)


def test_the_thickness_is_searched_while_the_depth_is(monkeypatch: pytest.MonkeyPatch) -> None:
    search, begun = core.search_depth, Event()
    thickness = core.search_thickness

    def deep(*surfaces: object, **goal: Any) -> core.DepthInterval:
        assert begun.wait(LONG)
        return search(*surfaces, **goal)

    def thick(*surfaces: object, **goal: Any) -> core.ThicknessInterval:
        begun.set()
        return thickness(*surfaces, **goal)

    monkeypatch.setattr(core, "search_depth", deep)
    monkeypatch.setattr(core, "search_thickness", thick)
    (finding,) = found("kettle.obj", "snowflake.obj")
    assert finding.relation == "penetrating"
    assert finding.thickness is not None


@pytest.mark.parametrize(
    ("names", "jobs"),
    [
        (("kettle.obj", "snowflake.obj"), 1),
        (("kettle.obj", "snowflake.obj", "l_bracket.obj"), 2),
    ],
    ids=["one thread", "several pairs"],
)
def test_else_one_is_searched_after_the_other(
    monkeypatch: pytest.MonkeyPatch, names: tuple[str, ...], jobs: int
) -> None:
    thickness, threads = core.search_thickness, set[Thread]()

    def thick(*surfaces: object, **goal: Any) -> core.ThicknessInterval:
        threads.add(current_thread())
        return thickness(*surfaces, **goal)

    monkeypatch.setattr(core, "search_thickness", thick)
    found(*names, jobs=jobs)
    assert threads == {main_thread()}


def test_a_system_without_threads_searches_both(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: Thread) -> None:
        raise RuntimeError("can't start new thread")

    expected = found("kettle.obj", "snowflake.obj")[0]
    monkeypatch.setattr(Thread, "start", refuse)
    assert found("kettle.obj", "snowflake.obj")[0].thickness_bounds == expected.thickness_bounds


def test_a_failure_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    def thick(*_: object, **__: object) -> None:
        raise ValueError("no ball")

    monkeypatch.setattr(core, "search_thickness", thick)
    (finding,) = found("kettle.obj", "snowflake.obj")
    assert finding.reason == "internal error: ValueError: no ball"


def test_ctrl_c_ends_both(monkeypatch: pytest.MonkeyPatch) -> None:
    begun, ended = Event(), Event()

    def deep(*_: object, **__: object) -> None:
        assert begun.wait(LONG)
        raise KeyboardInterrupt

    def thick(*_: object, progress: Search, **__: object) -> None:
        begun.set()
        try:
            while True:
                progress(0.0, 1.0, 0.5)
        finally:
            ended.set()

    monkeypatch.setattr(core, "search_depth", deep)
    monkeypatch.setattr(core, "search_thickness", thick)
    with pytest.raises(KeyboardInterrupt):
        found("kettle.obj", "snowflake.obj")
    assert ended.is_set()
