"""SAT and GJK + EPA: what they cost, and that they agree."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from satcheck.audit import Settings, check
from satcheck.audit.request.settings import METHODS, Method
from satcheck.scene import load_scene
from satcheck.studies.tradeoff import method_costs

SAMPLES = Path(__file__).resolve().parents[3] / "sample_meshes"
PAIRS = [
    ("box.obj", "box_pushed.stl"),
    ("box.obj", "box_flush.stl"),
    ("box.obj", "cube.off"),
    ("cube.off", "needle.stl"),
    ("kettle.obj", "snowflake.obj"),
    ("l_bracket.obj", "peg_in_notch.ply"),
]


@pytest.mark.parametrize("names", PAIRS)
@pytest.mark.parametrize("method", METHODS)
def test_every_method_gives_the_same_answer(names: tuple[str, str], method: Method) -> None:
    paths = [SAMPLES / name for name in names]
    settings = {"depth": True, "clearance": 100.0}
    (default,) = check(paths, Settings(**settings)).findings  # type: ignore[arg-type]
    (finding,) = check(paths, Settings(method=method, **settings)).findings  # type: ignore[arg-type]
    assert finding.relation == default.relation
    assert finding.exact_relation == default.exact_relation
    assert finding.quality == default.quality
    # Both figures are proven to the rounding of coordinates of size 10, times the 40 roundings of a
    # support value.
    rounding = 40 * math.ulp(10.0)
    for ours, theirs in ((finding.depth, default.depth), (finding.distance, default.distance)):
        assert (ours is None) == (theirs is None)
        assert ours is None or ours == pytest.approx(theirs, abs=rounding, rel=0.02)


def test_the_method_that_was_chosen_is_the_one_that_runs() -> None:
    """Of hulls that are no boxes to the core: GJK and EPA by default."""
    paths = [SAMPLES / "box.obj", SAMPLES / "box_pushed.stl"]

    def detail(method: Method) -> str:
        (finding,) = check(paths, Settings(depth=True, method=method)).findings
        return next(stage.detail for stage in finding.plan if stage.stage == "hull")

    assert "sat" in detail("sat")
    assert "sat" not in detail("gjk")
    assert detail("auto") == detail("gjk")


def test_costs_by_the_number_of_vertices() -> None:
    a, b = load_scene([SAMPLES / "kettle.obj", SAMPLES / "snowflake.obj"]).bodies
    costs = method_costs(a, b, 60.0)
    first = [cost.vertices[0] for cost in costs]
    assert first == sorted(first)
    assert costs[0].vertices == (4, 4)
    assert len(costs) > 3
    for cost in costs:
        assert cost.agree
        assert cost.sat > 0
        assert cost.gjk > 0


def test_without_time_nothing_is_measured() -> None:
    a, b = load_scene([SAMPLES / "box.obj", SAMPLES / "cube.off"]).bodies
    assert method_costs(a, b, 0.0) == ()
