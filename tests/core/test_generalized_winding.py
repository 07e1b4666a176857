"""Winding numbers of open surfaces: what the core says, and what the checker computes by itself."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh, Surface
from satcheck.verify.meshes import turns_around
from tests.audit.shapes import unit_box

POINTS, FACES = unit_box(edge=2.0)
TRIANGLES = [(f[0], f[k], f[k + 1]) for f in FACES for k in (1, 2)]
ROUNDING = 1e-14  # of a dozen arcs of at most pi, each to a few units in the last place


@pytest.mark.parametrize("faces", range(1, 6))
def test_each_face_of_a_cube_takes_a_sixth_at_its_middle(faces: int) -> None:
    triangles = np.array(TRIANGLES[: 2 * faces])
    surface = Surface(Mesh(np.array(POINTS), triangles), False, sheets=True)
    middle = (1.0, 1.0, 1.0)
    assert surface.sheets_around(middle) == pytest.approx(faces / 6, abs=ROUNDING)
    around = turns_around(np.array(POINTS)[triangles], np.array(middle))
    assert around == pytest.approx(faces / 6, abs=ROUNDING)


def test_what_is_no_sheet_does_not_count() -> None:
    closed = Surface(Mesh(np.array(POINTS), np.array(TRIANGLES)), True)
    holed = Surface(Mesh(np.array(POINTS), np.array(TRIANGLES[:10])), False)
    assert closed.sheets_around((1.0, 1.0, 1.0)) == holed.sheets_around((1.0, 1.0, 1.0)) == 0.0


def test_a_closed_surface_winds_once_within_and_not_at_all_without() -> None:
    corners = np.array(POINTS)[np.array(TRIANGLES)]
    for point, turns in (((0.1, 1.9, 0.3), 1.0), ((3.0, 1.0, 1.0), 0.0), ((-5.0, 9.0, 2.0), 0.0)):
        assert turns_around(corners, np.array(point)) == pytest.approx(turns, abs=ROUNDING)


def test_a_vertex_by_its_number() -> None:
    mesh = Mesh(np.array(POINTS), np.array(TRIANGLES))
    assert mesh.vertex(7) == (2.0, 2.0, 2.0)
    with pytest.raises(IndexError):
        mesh.vertex(8)
