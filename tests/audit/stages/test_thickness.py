"""The thickness of overlaps with known balls, where there is none, and what rules make of it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from satcheck.audit import Finding, Settings, check
from satcheck.scene import load_scene
from tests.audit.shapes import Mesh, box, bracket, open_box, scene_of, unit_box

WEDGE_HEIGHT = 0.25
# The incircle of a right-angled triangle on its hypotenuse, of this height.
WEDGE_THICKNESS = 2 * WEDGE_HEIGHT / (1 + math.sqrt(2))


def wedge(height: float = WEDGE_HEIGHT) -> Mesh:
    """A prism along y, a square on its corner: the edge reaches this deep into the unit box."""
    square = [(0.5, 1 - height), (1.5, 2 - height), (0.5, 3 - height), (-0.5, 2 - height)]
    points = [(x, y, z) for y in (0.0, 1.0) for x, z in square]
    walls = [(k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4) for k in range(4)]
    return points, [(3, 2, 1, 0), (4, 5, 6, 7), *walls]


def only(folder: Path, a: Mesh, b: Mesh, **settings: object) -> Finding:
    (finding,) = check(scene_of(folder, a=a, b=b), Settings(**settings)).findings  # type: ignore[arg-type]
    return finding


@pytest.mark.parametrize(
    ("a", "b", "thickness"),
    [
        (unit_box(), unit_box(0.75, 0.125), 0.25),
        (unit_box(), unit_box(0.25, 0.25, 0.25, edge=0.5), 0.5),
        (unit_box(), unit_box(), 1.0),
        (unit_box(), box((-1, 0.25, 0.25), (2, 0.375, 0.75)), 0.125),
        (unit_box(), wedge(), WEDGE_THICKNESS),
    ],
    ids=["slab", "inside", "the same", "through", "wedge"],
)
def test_known_balls(tmp_path: Path, a: Mesh, b: Mesh, thickness: float) -> None:
    found = only(tmp_path, a, b)
    assert found.thickness_bounds is not None
    assert found.ball is not None
    low, high = found.thickness_bounds
    assert low <= thickness * (1 + 1e-12)
    assert thickness * (1 - 1e-12) <= high == found.thickness <= low / 0.99
    assert found.ball.radius >= low / 2
    assert found.thickness <= (found.depth or 0.0)


def test_threads_change_nothing() -> None:
    samples = Path(__file__).parents[3] / "sample_meshes"
    scene = load_scene([samples / "kettle.obj", samples / "snowflake.obj"])
    one, two = (check(scene, Settings(jobs=jobs)).findings[0] for jobs in (1, 2))
    assert [(step.stage, step.detail) for step in one.plan] == [
        (step.stage, step.detail) for step in two.plan
    ]
    assert (one.thickness_bounds, one.ball) == (two.thickness_bounds, two.ball)


def test_a_ball_in_a_plane_is_a_disc(tmp_path: Path) -> None:
    low = box((0, 0, 0), (1, 1, 0.125))
    found = only(tmp_path, low, box((0.5, 0, 5), (2, 1, 6)), planar="xy")
    assert found.thickness == pytest.approx(0.5, rel=0.01)


@pytest.mark.parametrize(
    ("b", "settings", "why"),
    [
        (open_box(edge=0.5), {}, "b has holes"),
        (bracket(), {"accuracy": "hull"}, "found on triangles: not at --accuracy hull"),
    ],
)
def test_why_there_is_none(tmp_path: Path, b: Mesh, settings: dict[str, str], why: str) -> None:
    found = only(tmp_path, unit_box(-0.25, 0.0, 0.125), b, **settings)
    assert (found.thickness, found.thickness_bounds, found.ball) == (None, None, None)
    assert [stage.detail for stage in found.plan if stage.stage == "thickness"] == [why]
    assert found.depth is not None


def test_nobody_asks(tmp_path: Path) -> None:
    for settings in ({"depth": False}, {"thickness": False}):
        found = only(tmp_path, unit_box(), unit_box(0.75), **settings)
        assert found.thickness is None
        assert "thickness" not in [stage.stage for stage in found.plan]


@pytest.mark.parametrize(
    ("limit", "severity"), [("0.3", "note"), ("0.25", "note"), ("0.2", "error")]
)
def test_a_rule_limits_it(tmp_path: Path, limit: str, severity: str) -> None:
    (tmp_path / "cell.toml").write_text(f"""schema = "satcheck.scene/1"
[[bodies]]
id = "a"
shape = {{ type = "box", size = [1, 1, 1] }}
[[bodies]]
id = "b"
shape = {{ type = "box", size = [1, 1, 1] }}
position = [0.75, 0, 0]
[[rules]]
a = "a"
b = "b"
max_thickness = {limit}
""")
    report = check(load_scene([tmp_path / "cell.toml"]), Settings(depth=False))
    (found,) = report.findings
    assert (found.severity, found.depth) == (severity, None)
    assert report.rules[0].max_thickness == float(limit)
    asked = {effect.effect: effect.asked_by for effect in report.effects}
    assert (asked["depth"], asked["thickness"]) == ((), (report.rules[0].name,))
