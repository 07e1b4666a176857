"""DXF: closed lines, blocks, joined edges."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from typing import Any

import ezdxf
import pytest

from satcheck.scene.drawing.contour import Drawing
from satcheck.scene.drawing.dxf import read_dxf
from satcheck.scene.errors import MeshFileError


def read(draw: Callable[[Any, Any], object]) -> Drawing:
    document = ezdxf.new()
    document.header["$INSUNITS"] = 4
    draw(document.modelspace(), document)
    text = io.StringIO()
    document.write(text)
    return read_dxf(text.getvalue().encode())


def test_a_closed_polyline() -> None:
    drawing = read(lambda space, _: space.add_lwpolyline([(0, 0), (4, 0), (4, 3)], close=True))
    (shape,) = drawing.shapes
    assert drawing.units == "mm"
    assert set(shape.contours[0].points) == {(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)}


def test_bulges_are_arcs() -> None:
    """Two half circles of radius 5 about (5, 0)."""
    corners = [(0, 0, 0, 0, 1), (10, 0, 0, 0, 1)]
    drawing = read(lambda space, _: space.add_lwpolyline(corners, close=True))
    (contour,) = drawing.shapes[0].contours
    assert len(contour.points) > 100
    for x, y in contour.points:
        assert math.hypot(x - 5, y) == pytest.approx(5.0, abs=1e-12)
    assert 0 < contour.deviation <= 5 * 2.0**-13


@pytest.mark.parametrize("backwards", [False, True])
def test_edges_that_join_end_to_end_are_a_contour(backwards: bool) -> None:
    def draw(space: Any, _: Any) -> None:
        space.add_line((0, 0), (10, 0))
        space.add_line((10, 10), (10, 0)) if backwards else space.add_line((10, 0), (10, 10))
        space.add_line((10, 10), (0, 0))
        space.add_line((20, 0), (30, 0))

    drawing = read(draw)
    (shape,) = drawing.shapes
    assert set(shape.contours[0].points) == {(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)}
    assert drawing.ignored == ("open lines are ignored",)


def test_lines_within_lines_are_shapes_of_their_own() -> None:
    def draw(space: Any, _: Any) -> None:
        space.add_circle((0, 0), 5)
        space.add_circle((0, 0), 2)

    assert [len(shape.contours) for shape in read(draw).shapes] == [1, 1]


def test_a_block_is_one_shape_with_holes() -> None:
    def draw(space: Any, document: Any) -> None:
        block = document.blocks.new("plate")
        block.add_lwpolyline([(-3, -3), (3, -3), (3, 3), (-3, 3)], close=True)
        block.add_circle((0, 0), 1)
        for x in (0, 100):
            space.add_blockref("plate", (x, 0), dxfattribs={"xscale": 2})

    drawing = read(draw)
    assert [(len(shape.contours), shape.rule) for shape in drawing.shapes] == [(2, "evenodd")] * 2
    assert len({shape.name for shape in drawing.shapes}) == 2
    xs = [x for contour in drawing.shapes[1].contours for x, _ in contour.points]
    assert (min(xs), max(xs)) == (94.0, 106.0)


def test_what_is_left_out_is_said() -> None:
    def draw(space: Any, _: Any) -> None:
        space.add_circle((0, 0), 5)
        space.add_text("x")

    assert read(draw).ignored == ("annotations are ignored",)


@pytest.mark.parametrize("data", [b"hello", b"0\nSECTION\n2\nENTITIES\n0\nCIR"])
def test_broken_files_are_refused(data: bytes) -> None:
    with pytest.raises(MeshFileError) as caught:
        read_dxf(data)
    assert caught.value.code == "bad-record"
