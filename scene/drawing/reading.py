"""Reads drawings in a child process, because they are untrusted input to large parsers.

The request and its answer are MessagePack messages, and msgspec checks their types.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from satcheck.scene.drawing.contour import Drawing, DrawnShape, RefusedShape
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.raw_mesh import Block, Refusal
from satcheck.scene.loading.reading_children import ReadingChildren

if TYPE_CHECKING:
    from satcheck.scene.drawing.sheet import Sheet


class _Request(msgspec.Struct, frozen=True):
    """whole: all shapes become one sheet."""

    format: str
    whole: bool
    data: Block


class SheetMessage(msgspec.Struct, frozen=True, tag=True):
    """A `sheet.Sheet`. points: little-endian float64 x, y; triangles: uint32, three each."""

    name: str
    points: Block
    triangles: Block
    deviation: float
    inscribed: bool


class DrawingMessage(msgspec.Struct, frozen=True, tag=True):
    """sheets: one for all shapes, or one for each. units, ignored: as in Drawing."""

    units: str | None
    ignored: tuple[str, ...]
    sheets: tuple[SheetMessage | RefusedShape, ...]


def read_drawing(
    form: str, data: bytes, children: ReadingChildren, *, whole: bool, seconds: float
) -> DrawingMessage:
    """Raises MeshFileError if the drawing is refused, WorkerError if the child died."""
    request = msgspec.msgpack.encode(_Request(form, whole, data))
    reply = children.ask(__name__, request, seconds=seconds)
    answer = msgspec.msgpack.decode(reply, type=DrawingMessage | Refusal)
    if isinstance(answer, Refusal):
        raise MeshFileError(answer.code, answer.message)
    return answer


def serve(message: bytes) -> bytes:
    """Runs in the child process."""
    request = msgspec.msgpack.decode(message, type=_Request)
    answer: DrawingMessage | Refusal
    try:
        answer = _message(_drawing(request.format, bytes(request.data)), request.whole)
    except MeshFileError as error:
        answer = Refusal(error.code, error.message)
    return msgspec.msgpack.encode(answer)


def _drawing(form: str, data: bytes) -> Drawing:
    if form == "svg":
        from satcheck.scene.drawing.svg import read_svg

        return read_svg(data)
    from satcheck.scene.drawing.dxf import read_dxf

    return read_dxf(data)


def _message(drawing: Drawing, whole: bool) -> DrawingMessage:
    from satcheck.scene.drawing.sheet import sheet_of, united

    def triangulated(shape: DrawnShape | RefusedShape) -> Sheet:
        if isinstance(shape, RefusedShape):
            raise MeshFileError(shape.code, shape.message)
        return sheet_of(shape)

    def message(shape: DrawnShape | RefusedShape) -> SheetMessage | RefusedShape:
        try:
            return _sheet_message(triangulated(shape))
        except MeshFileError as error:
            return RefusedShape(shape.name, error.code, error.message)

    if not drawing.shapes:
        raise MeshFileError("empty-mesh", "the drawing has no closed outline")
    sheets: tuple[SheetMessage | RefusedShape, ...]
    if whole:
        sheets = (_sheet_message(united([triangulated(shape) for shape in drawing.shapes])),)
    else:
        sheets = tuple(map(message, drawing.shapes))
    return DrawingMessage(drawing.units, drawing.ignored, sheets)


def _sheet_message(sheet: Sheet) -> SheetMessage:
    return SheetMessage(
        sheet.name,
        sheet.points.astype("<f8").tobytes(),
        sheet.triangles.astype("<u4").tobytes(),
        sheet.deviation,
        sheet.inscribed,
    )
