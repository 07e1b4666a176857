"""Drawings are untrusted input to large parsers: they are read in a child process.

request: a line with the format and "whole" or "shapes", then the file's bytes. reply: JSON,
{"refusal": [code, message]} or {"units", "ignored", "sheets": [{"name", "points", "triangles",
"deviation", "inscribed"}]}, one for all shapes together or one each, where a shape that cannot be
used has a "refusal" in the place of its points.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from satcheck.scene.drawing.contour import Drawing, DrawnShape, RefusedShape
from satcheck.scene.errors import MeshFileError

if TYPE_CHECKING:
    from satcheck.scene.drawing.sheet import Sheet
    from satcheck.scene.loading.reading_children import ReadingChildren

_WORKER = "satcheck.scene.drawing.reading"


def read_drawing(
    form: str, data: bytes, children: ReadingChildren, *, whole: bool, seconds: float
) -> dict[str, Any]:
    """The reply as above; raises MeshFileError for a refusal, WorkerError for a child that died."""
    request = f"{form} {'whole' if whole else 'shapes'}\n".encode() + data
    reply = children.ask(_WORKER, request, seconds=seconds)
    found: dict[str, Any] = json.loads(reply)
    if "refusal" in found:
        code, message = found["refusal"]
        raise MeshFileError(code, message)
    return found


def serve(request: bytes) -> bytes:
    """In the child."""
    head, _, data = request.partition(b"\n")
    form, what = head.decode().split()
    try:
        return json.dumps(_answer(_drawing(form, data), what == "whole")).encode()
    except MeshFileError as error:
        return json.dumps({"refusal": [error.code, error.message]}).encode()


def _drawing(form: str, data: bytes) -> Drawing:
    if form == "svg":
        from satcheck.scene.drawing.svg import read_svg

        return read_svg(data)
    from satcheck.scene.drawing.dxf import read_dxf

    return read_dxf(data)


def _answer(drawing: Drawing, whole: bool) -> dict[str, Any]:
    if not drawing.shapes:
        raise MeshFileError("empty-mesh", "the drawing has no closed outline")
    from satcheck.scene.drawing.sheet import united

    if whole:
        sheets = [_reply(united([_sheet(shape) for shape in drawing.shapes]))]
    else:
        sheets = [_reply_of(shape) for shape in drawing.shapes]
    return {"units": drawing.units, "ignored": drawing.ignored, "sheets": sheets}


def _reply_of(shape: DrawnShape | RefusedShape) -> dict[str, Any]:
    try:
        return _reply(_sheet(shape))
    except MeshFileError as error:
        return {"name": shape.name, "refusal": [error.code, error.message]}


def _sheet(shape: DrawnShape | RefusedShape) -> Sheet:
    from satcheck.scene.drawing.sheet import sheet_of

    if isinstance(shape, RefusedShape):
        raise MeshFileError(shape.code, shape.message)
    return sheet_of(shape)


def _reply(sheet: Sheet) -> dict[str, Any]:
    return {
        "name": sheet.name,
        "points": sheet.points.tolist(),
        "triangles": sheet.triangles.tolist(),
        "deviation": sheet.deviation,
        "inscribed": sheet.inscribed,
    }
