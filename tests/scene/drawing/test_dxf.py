"""DXF: closed lines, blocks, joined edges."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import ezdxf
import pytest

from satcheck.scene.drawing.contour import Drawing, DrawnShape, RefusedShape
from satcheck.scene.drawing.dxf import read_dxf
from satcheck.scene.errors import MeshFileError


def read(draw: Callable[[Any, Any], object]) -> Drawing:
    document = ezdxf.new()
    document.header["$INSUNITS"] = 4
    draw(document.modelspace(), document)
    text = io.StringIO()
    document.write(text)
    return read_dxf(text.getvalue().encode())


def shapes_of(drawing: Drawing) -> list[DrawnShape]:
    shapes = [shape for shape in drawing.shapes if isinstance(shape, DrawnShape)]
    assert len(shapes) == len(drawing.shapes)
    return shapes


def test_a_closed_polyline() -> None:
    drawing = read(lambda space, _: space.add_lwpolyline([(0, 0), (4, 0), (4, 3)], close=True))
    (shape,) = shapes_of(drawing)
    assert drawing.units == "mm"
    assert set(shape.contours[0].points) == {(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)}


def test_bulges_are_arcs() -> None:
    """Two half circles of radius 5 about (5, 0)."""
    corners = [(0, 0, 0, 0, 1), (10, 0, 0, 0, 1)]
    drawing = read(lambda space, _: space.add_lwpolyline(corners, close=True))
    (contour,) = shapes_of(drawing)[0].contours
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
    (shape,) = shapes_of(drawing)
    assert set(shape.contours[0].points) == {(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)}
    assert drawing.ignored == ("open lines are ignored",)


def test_lines_within_lines_are_shapes_of_their_own() -> None:
    def draw(space: Any, _: Any) -> None:
        space.add_circle((0, 0), 5)
        space.add_circle((0, 0), 2)

    assert [len(shape.contours) for shape in shapes_of(read(draw))] == [1, 1]


def test_a_block_is_one_shape_with_holes() -> None:
    def draw(space: Any, document: Any) -> None:
        block = document.blocks.new("plate")
        block.add_lwpolyline([(-3, -3), (3, -3), (3, 3), (-3, 3)], close=True)
        block.add_circle((0, 0), 1)
        for x in (0, 100):
            space.add_blockref("plate", (x, 0), dxfattribs={"xscale": 2})

    drawing = read(draw)
    shapes = shapes_of(drawing)
    assert [(len(shape.contours), shape.rule) for shape in shapes] == [(2, "evenodd")] * 2
    assert len({shape.name for shape in shapes}) == 2
    xs = [x for contour in shapes[1].contours for x, _ in contour.points]
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


def square(space: Any, x: float, y: float, **attributes: object) -> None:
    corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]
    space.add_lwpolyline(corners, close=True, dxfattribs=attributes)


def extents(shape: DrawnShape | RefusedShape) -> tuple[float, ...]:
    """min x, min y, max x, max y; to 12 digits."""
    assert isinstance(shape, DrawnShape)
    points = [p for contour in (*shape.contours, *shape.filled) for p in contour.points]
    xs, ys = zip(*points, strict=True)
    return tuple(round(c, 12) for c in (min(xs), min(ys), max(xs), max(ys)))


@pytest.mark.parametrize(("rotation", "last"), [(0, (10, 0, 11, 1)), (90, (-1, 10, 0, 11))])
def test_each_copy_of_an_array_is_a_shape(rotation: int, last: tuple[float, ...]) -> None:
    def draw(space: Any, document: Any) -> None:
        square(document.blocks.new("b"), 0, 0)
        array = {"column_count": 3, "column_spacing": 5, "rotation": rotation}
        space.add_blockref("b", (0, 0), dxfattribs=array)

    shapes = read(draw).shapes
    assert len({shape.name for shape in shapes}) == 3
    assert extents(shapes[2]) == last


def test_an_array_within_a_block_under_an_uneven_scale() -> None:
    """Three unit squares, 5 apart, turned upward, twice as wide: x in [-2, 0], y up to 11."""

    def draw(space: Any, document: Any) -> None:
        square(document.blocks.new("inner"), 0, 0)
        array = {"column_count": 3, "column_spacing": 5, "rotation": 90}
        document.blocks.new("outer").add_blockref("inner", (0, 0), dxfattribs=array)
        space.add_blockref("outer", (100, 0), dxfattribs={"xscale": 2})

    (shape,) = read(draw).shapes
    assert isinstance(shape, DrawnShape)
    assert len(shape.contours) == 3
    assert extents(shape) == (98, 0, 100, 11)


@pytest.mark.parametrize("kind", ["add_solid", "add_trace", "add_3dface"])
def test_filled_corners_are_a_shape(kind: str) -> None:
    corners = [(0, 0), (4, 0), (4, 4), (0, 4)]
    if kind != "add_3dface":  # of the others, the third corner lies across from the second
        corners[2:] = corners[:1:-1]
    (shape,) = read(lambda space, _: getattr(space, kind)(corners)).shapes
    assert isinstance(shape, DrawnShape)
    assert shape.filled[0].points == ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))


def test_a_filled_area_in_a_block_makes_no_hole() -> None:
    def draw(space: Any, document: Any) -> None:
        block = document.blocks.new("b")
        block.add_lwpolyline([(0, 0), (9, 0), (9, 9), (0, 9)], close=True)
        block.add_solid([(1, 1), (2, 1), (1, 2), (2, 2)])
        space.add_blockref("b", (0, 0))

    (shape,) = read(draw).shapes
    assert isinstance(shape, DrawnShape)
    assert (len(shape.contours), len(shape.filled)) == (1, 1)


def test_a_hatch_is_a_shape_that_cannot_be_read() -> None:
    def draw(space: Any, document: Any) -> None:
        for where in (space, document.blocks.new("b")):
            where.add_hatch().paths.add_polyline_path([(0, 0), (1, 0), (1, 1)], is_closed=True)
        square(space, 3, 3)
        space.add_blockref("b", (9, 0))

    hatch, block, contour = read(draw).shapes
    assert isinstance(contour, DrawnShape)
    for refused in (hatch, block):
        assert isinstance(refused, RefusedShape)
        assert refused.code == "unsupported-feature"
        assert "HATCH" in refused.message


def test_what_a_program_does_not_show_is_left_out_with_one_note() -> None:
    def draw(space: Any, document: Any) -> None:
        document.layers.add("off").off()
        document.layers.add("frozen").freeze()
        block = document.blocks.new("b")
        square(block, 0, 0)  # on layer 0: on that of the reference
        square(block, 2, 0, layer="on")
        for hidden in ({"layer": "off"}, {"layer": "frozen"}, {"invisible": 1}):
            square(space, 0, 0, **hidden)
            space.add_blockref("b", (0, 0), dxfattribs=hidden)
        square(space, 7, 7, layer="on")

    drawing = read(draw)
    assert drawing.ignored == ("entities that are invisible, or on layers off, are left out",)
    assert [extents(shape) for shape in drawing.shapes] == [(2, 0, 3, 1), (7, 7, 8, 8)]


def test_a_line_drawn_twice_is_said_to_be() -> None:
    def draw(space: Any, _: Any) -> None:
        for a, b in pairwise([(0, 0), (2, 0), (2, 2), (0, 2), (0, 0), (2, 0)]):
            space.add_line(a, b)

    drawing = read(draw)
    assert drawing.ignored == ("lines that are drawn twice are taken once",)
    assert [extents(shape) for shape in drawing.shapes] == [(0, 0, 2, 2)]


def test_lines_that_share_an_edge_are_refused_and_no_other_shape_is() -> None:
    def draw(space: Any, _: Any) -> None:
        for a, b in pairwise([(2, 2), (0, 2), (0, 0), (2, 0), (2, 2), (4, 2), (4, 0), (2, 0)]):
            space.add_line(a, b)
        square(space, 7, 7)

    contour, lines = read(draw).shapes
    assert extents(contour) == (7, 7, 8, 8)
    assert isinstance(lines, RefusedShape)
    assert "three or more" in lines.message


def test_references_that_explode_are_counted_and_refused() -> None:
    def nested(space: Any, document: Any) -> None:
        square(document.blocks.new("b0"), 0, 0)
        for n in range(1, 40):
            block = document.blocks.new(f"b{n}")
            block.add_blockref(f"b{n - 1}", (0, 0))
            block.add_blockref(f"b{n - 1}", (1, 0))
        space.add_blockref("b39", (0, 0))

    def array(space: Any, document: Any) -> None:
        square(document.blocks.new("b"), 0, 0)
        size = {"row_count": 30000, "column_count": 30000, "row_spacing": 5, "column_spacing": 5}
        space.add_blockref("b", (0, 0), dxfattribs=size)

    for draw in (nested, array):
        with pytest.raises(MeshFileError) as caught:
            read(draw)
        assert caught.value.code == "too-large"


def test_coordinates_that_are_not_finite_spoil_their_own_shape() -> None:
    def draw(space: Any, document: Any) -> None:
        square(document.blocks.new("b"), 0, 1e200)
        space.add_blockref("b", (0, 0), dxfattribs={"yscale": 1e200})
        space.add_line((0, 0), (math.nan, 1))
        square(space, 0, 0)

    block, line, contour = read(draw).shapes
    assert extents(contour) == (0, 0, 1, 1)
    for refused in (block, line):
        assert isinstance(refused, RefusedShape)
        assert refused.code == "non-finite"


@pytest.mark.parametrize("closed", [False, True])
def test_a_line_with_a_width_is_a_filled_band_and_not_read(closed: bool) -> None:
    band = {"const_width": 2}
    corners = [(0, 0), (9, 0), (9, 9)]
    (shape,) = read(lambda s, _: s.add_lwpolyline(corners, close=closed, dxfattribs=band)).shapes
    assert isinstance(shape, RefusedShape)
    assert "width" in shape.message
