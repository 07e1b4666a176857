"""Drawings are untrusted input to large parsers: they are read in a child process.

request: a line with the format, then the file's bytes. reply: JSON, {"refusal": [code, message]} or
{"units", "ignored", "sheets": [{"name", "points", "triangles", "deviation"}]}, where a shape that
cannot be used has a "refusal" in the place of its points.
"""

from __future__ import annotations

import json
from typing import Any

from satcheck.scene.drawing.contour import Drawing, DrawnShape
from satcheck.scene.errors import MeshFileError

_WORKER = "satcheck.scene.drawing.reading"


def read_drawing(form: str, data: bytes, *, seconds: float, megabytes: int) -> dict[str, Any]:
    """The reply as above; raises MeshFileError for a refusal, WorkerError for a child that died."""
    from satcheck.core.worker import run_isolated

    reply = run_isolated(_WORKER, f"{form}\n".encode() + data, seconds=seconds, megabytes=megabytes)
    found: dict[str, Any] = json.loads(reply)
    if "refusal" in found:
        code, message = found["refusal"]
        raise MeshFileError(code, message)
    return found


def serve(request: bytes) -> bytes:
    """In the child."""
    form, _, data = request.partition(b"\n")
    try:
        return json.dumps(_answer(_drawing(form.decode(), data))).encode()
    except MeshFileError as error:
        return json.dumps({"refusal": [error.code, error.message]}).encode()


def _drawing(form: str, data: bytes) -> Drawing:
    if form == "svg":
        from satcheck.scene.drawing.svg import read_svg

        return read_svg(data)
    from satcheck.scene.drawing.dxf import read_dxf

    return read_dxf(data)


def _answer(drawing: Drawing) -> dict[str, Any]:
    if not drawing.shapes:
        raise MeshFileError("empty-mesh", "the drawing has no closed outline")
    return {
        "units": drawing.units,
        "ignored": drawing.ignored,
        "sheets": [_sheet(shape) for shape in drawing.shapes],
    }


def _sheet(shape: DrawnShape) -> dict[str, Any]:
    from satcheck.scene.drawing.sheet import sheet_of

    try:
        sheet = sheet_of(shape)
    except MeshFileError as error:
        return {"name": shape.name, "refusal": [error.code, error.message]}
    return {
        "name": sheet.name,
        "points": sheet.points.tolist(),
        "triangles": sheet.triangles.tolist(),
        "deviation": sheet.deviation,
    }
