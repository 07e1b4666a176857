"""decompose/components.py: pieces may be decomposed alone, and give the whole solid."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.core import Mesh
from satcheck.decompose.components import diagonal, independent_pieces, merged


def scaled(mesh: Mesh, factor: float) -> Mesh:
    return Mesh(np.asarray(mesh.vertices) * factor, np.asarray(mesh.triangles))


def turned_inside_out(mesh: Mesh) -> Mesh:
    return Mesh(
        np.asarray(mesh.vertices), np.ascontiguousarray(np.asarray(mesh.triangles)[:, ::-1])
    )


def test_one_component_is_one_piece(l_shape: Mesh) -> None:
    assert independent_pieces(l_shape) == [l_shape]


def test_separate_shells_are_separate_pieces(box: Mesh, l_shape: Mesh) -> None:
    pieces = independent_pieces(merged([box, l_shape.translated((5.0, 0.0, 0.0))]))
    assert sorted(piece.triangle_count for piece in pieces) == [12, l_shape.triangle_count]


def test_overlapping_shells_are_separate_pieces(box: Mesh) -> None:
    assert len(independent_pieces(merged([box, box.translated((0.5, 0.0, 0.0))]))) == 2


def test_a_cavity_stays_with_its_shell(box: Mesh) -> None:
    shell = scaled(box, 4.0)
    cavity = turned_inside_out(box.translated((1.0, 1.0, 1.0)))
    beside = box.translated((9.0, 0.0, 0.0))
    pieces = independent_pieces(merged([cavity, beside, shell]))
    assert sorted(piece.topology().volume for piece in pieces) == pytest.approx([1.0, 63.0])


def test_a_shell_within_a_cavity_is_not_lost(box: Mesh) -> None:
    shell = scaled(box, 8.0)
    cavity = turned_inside_out(scaled(box, 4.0).translated((1.0, 1.0, 1.0)))
    kernel = box.translated((2.0, 2.0, 2.0))
    pieces = independent_pieces(merged([shell, cavity, kernel]))
    assert sum(piece.topology().volume for piece in pieces) == pytest.approx(512.0 - 64.0 + 1.0)


def test_merging_keeps_every_triangle_in_place(box: Mesh, l_shape: Mesh) -> None:
    both = merged([box, l_shape])
    corners = np.asarray(both.vertices)[np.asarray(both.triangles)]
    expected = [np.asarray(mesh.vertices)[np.asarray(mesh.triangles)] for mesh in (box, l_shape)]
    np.testing.assert_array_equal(corners, np.concatenate(expected))


def test_diagonal(l_shape: Mesh) -> None:
    assert diagonal(l_shape) == pytest.approx(3.0)
