"""decompose/half_spaces.py: from a body to its planes."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh
from satcheck.decompose.half_spaces import HalfSpaces, around


def half_spaces_of(mesh: Mesh) -> HalfSpaces:
    hull = mesh.convex_hull()
    return around(np.asarray(hull.vertices), np.asarray(hull.triangles))


def test_slack_is_positive_inside(box: Mesh) -> None:
    body = half_spaces_of(box)
    inside, outside = body.slack(np.array([[0.5, 0.5, 0.25], [0.5, 0.5, 1.5]]))
    assert inside.min() == pytest.approx(0.25)
    assert outside.min() == pytest.approx(-0.5)
