"""A JSON report of a check or of many assets as a file, and its bodies, read again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
from msgspec import to_builtins

from satcheck.core.errors import SatcheckError
from satcheck.report.assets import AssetsReport
from satcheck.report.report import Issue, Report
from satcheck.scene import Body, MeshFile, MeshFiles, Refused, Scene
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import FilePart
from satcheck.scene.files.nodes import CORNER
from satcheck.scene.files.readers import ReadLimits
from satcheck.scene.inspect import shape_file
from satcheck.scene.opening import Permitted, read_whole
from satcheck.scene.planar.outline import shape_from

if TYPE_CHECKING:
    from satcheck.report.bodies import BodyReport
    from satcheck.report.report import Report

CHANGED, GONE = "changed-file", "not-drawn"


MOST_BYTES = 1 << 30


def stated_scene(
    report: Report, root: Path, *, allow_outside: bool = False
) -> tuple[Scene, list[Issue]]:
    """The bodies that can be read, and what is not as it was when the report was made: a body
    whose file has changed is there as it is now. root: where the paths in the report start."""
    permitted = Permitted(anywhere=allow_outside)
    files = MeshFiles(ReadLimits(permitted=permitted, options=report.reading or {}))
    bodies: list[Body] = []
    issues: list[Issue] = []
    for entry in report.bodies:
        if entry.sha256 is None:
            continue  # the report says why
        file = _mesh_file(entry, files, root)
        if isinstance(file, Refused):
            issues.append(_issue(GONE, entry, f"not drawn: {file}"))
            continue
        body = _placed(entry, file)
        try:
            CORNER.transformed(body.transform or IDENTITY)
        except (ValueError, OverflowError) as error:
            issues.append(_issue(GONE, entry, f"not drawn: {error}"))
            continue
        bodies.append(body)
        if file.sha256 != entry.sha256:
            changed = f"{entry.file} has changed since the report was made"
            issues.append(_issue(CHANGED, entry, f"{changed}: the body is drawn as it is now"))
    return Scene(name="", units=report.units, bodies=tuple(bodies)), list(_once(issues))


def _mesh_file(entry: BodyReport, files: MeshFiles, root: Path) -> MeshFile | Refused:
    """Return the mesh file of a body. Of a shape the report has the sizes: the file that states it
    is not read again."""
    location = str(root / entry.file)
    if entry.shape is not None:
        try:
            return shape_file(shape_from(to_builtins(entry.shape)), entry.file)
        except Refused as error:
            return error
    return files.mesh(FilePart(entry.file, location, entry.path))


def _placed(entry: BodyReport, file: MeshFile) -> Body:
    shape = None if entry.shape is None else shape_from(to_builtins(entry.shape))
    return Body(entry.id, entry.name, file, entry.transform, shape=shape, path=entry.path)


def _issue(code: str, entry: BodyReport, message: str) -> Issue:
    return Issue(code, "warning", entry.id, entry.file, message)


def _once(issues: Sequence[Issue]) -> Iterator[Issue]:
    """One issue a cause: bodies of one file share it."""
    told: set[tuple[str, str | None, str]] = set()
    for issue in issues:
        cause = (issue.code, issue.file, issue.message)
        if cause not in told:
            told.add(cause)
            yield issue


def read_report(path: Path) -> Report | AssetsReport:
    """Raises SatcheckError: `bad-report`, or a code about the file."""
    try:
        data = read_whole(str(path), path, MOST_BYTES)
        head = msgspec.json.decode(data)
        if isinstance(head, dict) and "assets" in head:
            return msgspec.convert(head, AssetsReport)
        return msgspec.convert(head, Report)
    except (msgspec.MsgspecError, UnicodeError, RecursionError) as error:
        reason = f"no JSON report of this version of satcheck: {error}"
        raise SatcheckError("bad-report", reason, file=str(path)) from None
