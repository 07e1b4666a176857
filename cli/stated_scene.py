"""A JSON report of a check or of many assets as a file, and its bodies, read again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, cast

import msgspec
from msgspec import to_builtins

from satcheck.core.errors import SatcheckError
from satcheck.report.assets import AssetsReport
from satcheck.report.report import Issue, Report
from satcheck.report.samples import SampledBody, SamplesReport
from satcheck.report.sweep import JointPath
from satcheck.scene import Body, MeshFiles, Refused, Scene
from satcheck.scene.access import Permitted
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import FilePart
from satcheck.scene.files.nodes import CORNER
from satcheck.scene.files.readers import ReadLimits
from satcheck.scene.motion import Motion, PosePath, Rotation, Translation
from satcheck.scene.opening import read_whole
from satcheck.scene.planar.outline import shape_from

if TYPE_CHECKING:
    from satcheck.report.bodies import BodyReport
    from satcheck.report.sweep import StatedMotion

CHANGED, GONE = "changed-file", "not-drawn"


_PATHS = {"translation": Translation, "rotation": Rotation, "path": PosePath}
_NO_PATH = (
    "the report does not say how the links of a robot move on its path, so they stand as at its "
    "start: satcheck ROBOT --path FILE -o page.html shows the path"
)


def stated_scene(
    report: Report | SamplesReport, root: Path, *, allow_outside: bool = False
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
        body = _body(entry, files, root)
        if isinstance(body, Refused):
            missing = body.code == "file-not-found"
            hint = " (--root names the folder where the check ran)" if missing else ""
            issues.append(_issue(GONE, entry, f"not drawn: {body}{hint}"))
            continue
        try:
            CORNER.transformed(body.transform or IDENTITY)
        except (ValueError, OverflowError) as error:
            issues.append(_issue(GONE, entry, f"not drawn: {error}"))
            continue
        bodies.append(body)
        if body.file.sha256 != entry.sha256:
            changed = f"{entry.file} has changed since the report was made"
            issues.append(_issue(CHANGED, entry, f"{changed}: the body is drawn as it is now"))
    motions = () if isinstance(report, SamplesReport) else report.motions
    if any(isinstance(motion, JointPath) for motion in motions):
        issues.append(Issue(GONE, "warning", None, None, _NO_PATH))
    moving = tuple(_motion(each) for each in motions if not isinstance(each, JointPath))
    scene = Scene(name="", units=report.units, bodies=tuple(bodies), motions=moving)
    # One issue a cause: bodies of one file share it.
    first: dict[tuple[str | None, ...], Issue] = {}
    for issue in issues:
        first.setdefault((issue.code, issue.file, issue.message), issue)
    return scene, [*first.values()]


def _motion(stated: StatedMotion) -> Motion:
    values = to_builtins(stated)
    return Motion(stated.bodies, msgspec.convert(values, _PATHS[values["kind"]]), stated.clear)


def _body(entry: BodyReport | SampledBody, files: MeshFiles, root: Path) -> Body | Refused:
    """Return the body. Of a shape the report has the sizes: the file that states it is not read
    again."""
    shape = None if entry.shape is None else shape_from(to_builtins(entry.shape))
    if shape is not None:
        file = files.shape(shape, entry.file)
    else:
        file = files.mesh(FilePart(entry.file, str(root / entry.file), entry.path))
    if isinstance(file, Refused):
        return file
    return Body(entry.id, entry.name, file, entry.transform, shape=shape, path=entry.path)


def _issue(code: str, entry: BodyReport | SampledBody, message: str) -> Issue:
    return Issue(code, "warning", entry.id, entry.file, message)


def read_stored(path: Path) -> Report | AssetsReport | SamplesReport:
    """Return the report in a file. Raises SatcheckError: `bad-report`, or a code about the file."""
    try:
        head = msgspec.json.decode(read_whole(path))
        kinds = {"assets": AssetsReport, "samples": SamplesReport} if isinstance(head, dict) else {}
        kind = next((kinds[field] for field in kinds if field in head), Report)
        return cast("Report | AssetsReport | SamplesReport", msgspec.convert(head, kind))
    except (msgspec.MsgspecError, UnicodeError, RecursionError) as error:
        reason = f"no report of a check by this version of satcheck: {error}"
        if path.suffix.lower() != ".json":
            reason = "no JSON report: a check writes one with -o report.json"
        raise SatcheckError("bad-report", reason, file=str(path)) from None
