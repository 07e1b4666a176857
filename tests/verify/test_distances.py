"""How far apart two bodies are: true figures are proven, no other figure is."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from satcheck.verify import distances
from tests.audit.shapes import Mesh, bracket, unit_box
from tests.audit.stages.test_exact_gap import needles
from tests.verify.honest import document, honest, write
from tests.verify.reports import Json, pieces, verified, wall

# A wedge and a box apart from it. The face x + y + z = 2.9 of the wedge has a large box.
CORNERS = [(4.0, -0.6, -0.5), (-0.6, 4.0, -0.5), (-0.5, -0.6, 4.0), (5.0, 5.0, 5.0)]
SLANTED = pieces((CORNERS, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]), unit_box(20.0))
APART = ("apart in a notch", "near", "in parts", "curved")


def left(made: Json) -> set[str]:
    found = verified(made)
    assert found.accepted, [one.reason for one in found.findings]
    return {one.field for one in found.not_covered}


@pytest.mark.parametrize("name", [*APART, "a gap in the touch band"])
def test_the_distance_is_proven(name: str) -> None:
    assert any(one["distance"] is not None for one in honest(name)["findings"])
    assert "findings[].distance" not in left(honest(name))


@pytest.mark.parametrize("name", APART)
@pytest.mark.parametrize("factor", [1 - 1e-6, 1 + 1e-6])
def test_a_distance_a_little_off_is_rejected(name: str, factor: float) -> None:
    made = honest(name)
    for number, finding in enumerate(made["findings"]):
        if finding["distance"]:
            finding["distance"] *= factor
            found = verified(made).findings[number]
            assert found.outcome == "rejected", found
            finding["distance"] /= factor


def moved_along(finding: Json, by: float) -> None:
    """The distance and the witness of B, together."""
    finding["distance"] += by
    finding["witness"]["b"] = [
        p + by * n for p, n in zip(finding["witness"]["b"], finding["normal"], strict=True)
    ]


@pytest.mark.parametrize("by", [-1e-3, 1e-3])
def test_witness_points_that_fit_a_false_distance_do_not_help(by: float) -> None:
    for name in ("apart in a notch", "near", "in parts"):
        made = honest(name)
        moved_along(made["findings"][0], by)
        assert verified(made).findings[0].outcome == "rejected"


@pytest.mark.parametrize("convex", [True, False])
def test_a_distance_is_right_to_the_last_rounding(tmp_path: Path, convex: bool) -> None:
    """1e-12 is far below the rounding of coordinates near 10, but the points are there."""
    a, b = needles(1e-12)
    if not convex:
        a, b = pieces(a, unit_box(50.0)), pieces(b, unit_box(-60.0))
    made = document(write(tmp_path, a=a, b=b), clearance=4e-12, tolerance=0.0)
    (finding,), (found,) = made["findings"], verified(made).findings
    assert found.distance_error == pytest.approx(3e-21)
    for distance in (3e-12 * (1 - 1e-8), 3e-12 * (1 + 1e-8), 4e-12):
        finding["distance"] = distance
        assert verified(made).findings[0].outcome == "rejected"
    if convex:
        finding["distance"] = 4e-12
        finding["certificate"].pop("distance")
        assert "findings[].distance" in left(made)


def test_the_error_of_a_proven_distance_is_said() -> None:
    for name in APART:
        for finding, found in zip(
            honest(name)["findings"], verified(honest(name)).findings, strict=True
        ):
            error = found.distance_error
            assert (error is None) is (finding["distance"] is None)
            assert error is None or error <= 1e-8 * (1 + finding["distance"])


def test_a_distance_without_evidence_is_named() -> None:
    made = honest("a gap in the touch band")
    made["findings"][0]["certificate"].pop("distance")
    assert "findings[].distance" in left(made)


def test_exact_figures_have_no_bounds() -> None:
    made = honest("near")
    distance = made["findings"][0]["distance"]
    made["findings"][0] |= {"distance_bounds": [0.5 * distance, distance], "quality": "bounded"}
    assert verified(made).findings[0].outcome == "rejected"


def test_a_wall_of_no_thickness_is_near(tmp_path: Path) -> None:
    """It stands closer than the bracket: the distance is that to its corner, and no less."""
    a: Mesh = pieces(wall(2.0, 2.0, 2.0), bracket())
    made = document(write(tmp_path, a=a, b=unit_box(3.5, 3.5, 1.0)), clearance=3.0)
    finding: dict[str, Any] = made["findings"][0]
    assert finding["distance"] == pytest.approx(0.5**0.5)
    assert verified(made).accepted
    finding.update(distance=0.5, normal=[1.0, 0.0, 0.0])
    finding["witness"] = {"a": [3.0, 3.0, 2.0], "b": [3.5, 3.5, 2.0]}
    assert not verified(made).accepted


def test_too_many_triangles_leave_it_unproven(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(distances, "MOST_NEAR", 0)
    made = document(write(tmp_path, a=SLANTED, b=unit_box(edge=0.5)), clearance=1.0)
    assert "findings[].distance" in left(made)


def test_the_reports_here_are_at_an_angle_too(tmp_path: Path) -> None:
    """Between two edges, and between a corner and a face, at distances that no float64 is."""
    slanted = document(write(tmp_path, a=SLANTED, b=unit_box(edge=0.5)), clearance=1.0)
    assert "findings[].distance" not in left(slanted)
    third = math.sqrt(1 / 3)
    for b in (unit_box(2.0 + third, 2.0 + third, 1.0), unit_box(6.0 + third, 2.1, 4.0 + third)):
        made = document(write(tmp_path, a=bracket(), b=b), clearance=2.0)
        assert made["findings"][0]["distance"] > 0.5
        assert "findings[].distance" not in left(made)
