"""Coordinates beyond what the predicates and bounds are proven for are refused, never judged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from satcheck import core

LIMITS = Path(__file__).resolve().parents[2] / "docs" / "limits.md"
TETRAHEDRON = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], dtype=np.int64)


@pytest.mark.parametrize("scale", [1e-44, 1e-9, 1.0, 1e9, 1e44])
def test_within_the_range_scale_changes_nothing(scale: float) -> None:
    a = core.Surface(core.Mesh(TETRAHEDRON * scale, FACES), True)
    b = core.Surface(core.Mesh((TETRAHEDRON + 0.25) * scale, FACES), True)
    assert core.mesh_relation(a, b).relation == "penetrating"
    result = core.check_pair(core.Hull(a.mesh.vertices), core.Hull(b.mesh.vertices))
    assert result.outcome == "penetrating"
    # x + y + z <= 1 is left by a quarter: the corner of B at 0.75 / 3 along (1, 1, 1).
    assert result.distance == pytest.approx(-0.25 / np.sqrt(3) * scale, rel=1e-12)


@pytest.mark.parametrize("coordinate", [1e46, -1e200])
def test_beyond_it_meshes_hulls_and_poses_are_refused(coordinate: float) -> None:
    points = TETRAHEDRON.copy()
    points[1, 0] = coordinate
    with pytest.raises(OverflowError, match="out of range"):
        core.Mesh(points, FACES)
    with pytest.raises(OverflowError, match="out of range"):
        core.Hull(points)
    ball = core.Sphere(1.0)
    with pytest.raises(OverflowError, match="out of range"):
        core.check_pair(ball, ball, pose_b=(coordinate, 0, 0))


def test_the_limits_are_those_of_the_docs() -> None:
    corner = np.array([[5e-324, 0, 0], [1e-45, 0, 0], [0, 1e-45, 0], [0, 0, 1e45]])
    assert len(core.Mesh(corner, FACES).vertices) == 4
    with pytest.raises(OverflowError, match="below 1e-45"):
        core.Mesh(TETRAHEDRON * 9e-46, FACES)
    limits = next(line for line in LIMITS.read_text("utf-8").splitlines() if "1e45" in line)
    assert "beyond 1e45, or less than 1e-45 across" in limits


def test_a_body_too_small_is_refused() -> None:
    with pytest.raises(OverflowError, match="size"):
        core.Mesh(TETRAHEDRON * 1e-50, FACES)


def test_not_a_number_is_another_matter() -> None:
    points = TETRAHEDRON.copy()
    points[2, 1] = np.nan
    with pytest.raises(ValueError, match="not finite"):
        core.Mesh(points, FACES)
