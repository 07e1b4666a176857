"""Overlaps that surfaces which are off explain, and those that nothing excuses."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit import Finding, Settings, check
from satcheck.audit.stages import explained
from satcheck.scene import load_scene
from tests.audit.shapes import Mesh, box, open_box, unit_box, write
from tests.audit.stages.test_thickness import WEDGE_HEIGHT, WEDGE_THICKNESS, only, wedge

PLATE = box((-1, -1, -1.75), (1, 1, -1.625))
# A pyramid with its tip down, 0.09 wide where it passes through the plate.
SPIKE = (
    [(-0.25, -0.25, 0.0), (0.25, -0.25, 0.0), (0.25, 0.25, 0.0), (-0.25, 0.25, 0.0), (0, 0, -2.0)],
    [(0, 1, 2, 3), (1, 0, 4), (2, 1, 4), (3, 2, 4), (0, 3, 4)],
)


def told(found: Finding) -> str:
    return " ".join(stage.detail for stage in found.plan if stage.stage == "touch-band")


@pytest.mark.parametrize(
    ("tolerance", "relation"),
    [
        (WEDGE_HEIGHT, "touching"),
        (WEDGE_THICKNESS * 1.001, "touching"),
        (WEDGE_THICKNESS * 0.999, "penetrating"),
        (0.0, "penetrating"),
    ],
)
def test_the_band_ends_at_the_thickness(tmp_path: Path, tolerance: float, relation: str) -> None:
    found = only(tmp_path, unit_box(), wedge(), tolerance=tolerance)
    assert (found.relation, found.exact_relation) == (relation, "penetrating")
    assert found.depth == pytest.approx(WEDGE_HEIGHT)
    swapped = only(tmp_path, wedge(), unit_box(), tolerance=tolerance)
    assert swapped.relation == relation


def test_a_thickness_away_from_the_band_needs_no_proof_to_the_last_digit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(explained, "_fit_of_convex", None)
    monkeypatch.setattr(explained, "_fit", None)
    found = only(tmp_path, unit_box(), wedge(), tolerance=1.02 * WEDGE_THICKNESS, depth=False)
    assert (found.relation, found.reason) == ("touching", None)


@pytest.mark.parametrize(
    ("off", "relation"),
    [
        ({"surface_tolerance": 0.51 * WEDGE_THICKNESS}, "touching"),
        ({"surface_tolerance": 0.49 * WEDGE_THICKNESS}, "penetrating"),
        ({"surface_tolerance": 0.51 * WEDGE_THICKNESS, "depth": False}, "touching"),
    ],
)
def test_a_surface_tolerance_is_that_of_each_body(
    tmp_path: Path, off: dict[str, float], relation: str
) -> None:
    found = only(tmp_path, unit_box(), wedge(), **off)
    assert (found.relation, found.exact_relation) == (relation, "penetrating")
    assert found.thickness == pytest.approx(WEDGE_THICKNESS, rel=0.01)
    assert found.severity == ("note" if relation == "touching" else "error")


def test_one_that_is_off_explains_it_alone(tmp_path: Path) -> None:
    """The wedge reaches no deeper into the box than that, but for a hair."""
    write(tmp_path, box=unit_box(), wedge=wedge())
    for off, relation in ((0.26, "touching"), (0.1, "penetrating")):
        (tmp_path / "cell.toml").write_text(f"""schema = "satcheck.scene/1"
units = "mm"
[[bodies]]
id = "box"
mesh = "box.obj"
surface_tolerance = "{off * 1000}um"
[[bodies]]
id = "wedge"
mesh = "wedge.obj"
""")
        report = check(load_scene([tmp_path / "cell.toml"]))
        assert [body.surface_tolerance for body in report.bodies] == [pytest.approx(off), None]
        assert report.findings[0].relation == relation


def test_a_body_as_thin_as_its_tolerance_excuses_nothing(tmp_path: Path) -> None:
    plate = box((-1, -1, 0.9), (2, 2, 1.0))
    found = only(tmp_path, plate, wedge(0.0625), surface_tolerance=0.0625)
    assert found.relation == "penetrating"
    assert "is not known to be thicker" in told(found)
    assert found.reason == (
        "the surface tolerance excuses nothing: a is not known to be thicker than its tolerance"
    )


def test_a_body_that_passes_through_excuses_nothing(tmp_path: Path) -> None:
    found = only(tmp_path, PLATE, SPIKE, surface_tolerance=0.05)
    assert found.relation == "penetrating"
    assert "passes through" in told(found)
    assert found.reason == (
        "the surface tolerance excuses nothing: one body passes through the other"
    )


# A block with a fin, 0.02 thick, that reaches 0.8 into another block.
FINNED = box((-3, -1, -1), (-1, 1, 1)), box((-1.5, -0.01, -0.5), (0.8, 0.01, 0.5))
BLOCK = box((0, -2, -2), (3, 2, 2))


def joined(first: Mesh, other: Mesh) -> Mesh:
    faces = [tuple(i + len(first[0]) for i in face) for face in other[1]]
    return [*first[0], *other[0]], [*first[1], *faces]


def moved(mesh: Mesh, back: float) -> Mesh:
    return [(x - back, y, z) for x, y, z in mesh[0]], mesh[1]


@pytest.mark.parametrize("apart", [0.0, 3.0])
def test_a_thin_part_that_reaches_deep_excuses_nothing(tmp_path: Path, apart: float) -> None:
    """Whether it hangs together with the rest of its body or not."""
    finned = joined(moved(FINNED[0], apart), FINNED[1])
    for pair in ((finned, BLOCK), (BLOCK, finned)):
        found = only(tmp_path, *pair, surface_tolerance=0.02)
        assert found.relation == "penetrating"
        assert "a thin part" in told(found)
        assert (found.reason or "").startswith("the surface tolerance excuses nothing: a thin part")


@pytest.mark.parametrize("surface_tolerance", [None, 0.03])
def test_the_touch_band_ends_at_the_thickness_of_a_fin(
    tmp_path: Path, surface_tolerance: float | None
) -> None:
    """However deep it reaches, and whatever a surface tolerance does not excuse."""
    finned = joined(moved(FINNED[0], 3.0), FINNED[1])
    for tolerance, relation in ((0.0201, "touching"), (0.0199, "penetrating")):
        off = {"tolerance": tolerance, "surface_tolerance": surface_tolerance}
        assert only(tmp_path, finned, BLOCK, **off).relation == relation


def test_a_plate_thinner_than_the_tolerance_touches(tmp_path: Path) -> None:
    plate = box((-1, -1, 0.9), (2, 2, 1.0))
    for tolerance, relation in ((0.1001, "touching"), (0.0999, "penetrating")):
        found = only(tmp_path, unit_box(), plate, tolerance=tolerance)
        assert (found.relation, found.exact_relation) == (relation, "penetrating")


def test_a_spike_through_a_thinner_plate_is_no_touch(tmp_path: Path) -> None:
    assert only(tmp_path, PLATE, SPIKE, tolerance=0.2).relation == "penetrating"


@pytest.mark.parametrize(("reach", "relation"), [(0.156, "touching"), (0.164, "penetrating")])
def test_a_thin_part_may_reach_a_little(tmp_path: Path, reach: float, relation: str) -> None:
    """4 times two tolerances of 0.02 are 0.16."""
    fin = box((-1.5, -0.01, -0.5), (reach, 0.01, 0.5))
    found = only(tmp_path, joined(moved(FINNED[0], 3.0), fin), BLOCK, surface_tolerance=0.02)
    assert found.relation == relation


def test_the_reason_names_the_open_question(tmp_path: Path) -> None:
    """Where two solids of one body meet in the plate, passing through is not decided."""
    half = box((-0.01, -0.01, -1.7), (0.01, 0.01, -1))
    pins = joined(joined(half, box((-0.01, -0.01, -3), (0.01, 0.01, -1.69))), FINNED[0])
    found = only(tmp_path, PLATE, pins, surface_tolerance=0.02)
    assert found.relation == "indeterminate"
    assert found.reason == "undecided: whether one body passes through the other"


def test_open_bodies_have_no_surface_that_is_off(tmp_path: Path) -> None:
    found = only(tmp_path, unit_box(-0.25), open_box(), surface_tolerance=0.25)
    assert found.relation == "penetrating"
    assert found.reason == "the surface tolerance excuses nothing: b has holes"


def test_what_the_budget_leaves_open_is_no_pass(tmp_path: Path) -> None:
    settings = Settings(surface_tolerance=0.49 * WEDGE_THICKNESS, budget=1e-6)
    a, b = write(tmp_path, a=unit_box(), b=wedge())
    report = check(load_scene([a, b]), settings)
    assert report.summary.verdict in ("fail", "incomplete")
