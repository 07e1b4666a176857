"""SAT and GJK + EPA: what they cost, and that they agree."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit import Settings, check
from satcheck.audit.request.settings import METHODS, Method
from satcheck.scene import load_scene
from satcheck.studies.tradeoff import method_costs
from tests.hard_cases.test_stability import FIGURE_ROUNDOFFS, U

SAMPLES = Path(__file__).resolve().parents[3] / "sample_meshes"
CONVEX = [
    ("box.obj", "box_pushed.stl"),
    ("box.obj", "box_flush.stl"),
    ("box.obj", "cube.off"),
    ("cube.off", "needle.stl"),
]
CONCAVE = [("kettle.obj", "snowflake.obj"), ("l_bracket.obj", "peg_in_notch.ply")]


@pytest.mark.parametrize("names", CONVEX + CONCAVE)
@pytest.mark.parametrize("method", METHODS)
def test_every_method_gives_the_same_answer(names: tuple[str, str], method: Method) -> None:
    paths = [SAMPLES / name for name in names]
    settings = {"depth": True, "clearance": 100.0}
    default = check(paths, Settings(**settings))  # type: ignore[arg-type]
    report = check(paths, Settings(method=method, **settings))  # type: ignore[arg-type]
    (expected,), (finding,) = default.findings, report.findings
    assert report.settings.method == method
    assert finding.relation == expected.relation
    assert finding.exact_relation == expected.exact_relation
    assert finding.quality == expected.quality
    assert (finding.depth is None) == (expected.depth is None)
    assert (finding.distance is None) == (expected.distance is None)
    bodies = load_scene(paths).bodies
    largest = max(float(abs(body.world_mesh().vertices).max()) for body in bodies)
    # Each of the two figures may be off by so much.
    rounding = 2 * FIGURE_ROUNDOFFS * U * largest
    if finding.distance is not None and expected.distance is not None:
        assert abs(finding.distance - expected.distance) <= rounding
    if finding.depth_bounds is not None and expected.depth_bounds is not None:
        (low, high), (expected_low, expected_high) = finding.depth_bounds, expected.depth_bounds
        # Both intervals contain the true depth.
        assert max(low, expected_low) <= min(high, expected_high)
        if names in CONVEX:
            assert high - low <= rounding
            assert expected_high - expected_low <= rounding
            assert abs(high - expected_high) <= rounding


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
