"""The results of a batch as rows of three tables, for questions in SQL."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec import Struct

from satcheck.audit.severity import fails
from satcheck.batch.stored import Stored
from satcheck.report.report import Finding, Report
from satcheck.report.values import Interval


class SceneRow(Struct, frozen=True):
    """A scene. scene: its name in the other tables. verdict: error, fail, incomplete or pass.
    bodies, pairs: how many. decided, pruned, allowed, indeterminate: the parts of pairs. exempt:
    pairs that do not count. errors, warnings, notes: the number of findings with this severity.
    units: of all its lengths, null where unknown. version: of satcheck."""

    scene: str
    files: tuple[str, ...]
    verdict: str
    bodies: int
    pairs: int
    decided: int
    pruned: int
    allowed: int
    indeterminate: int
    exempt: int
    errors: int
    warnings: int
    notes: int
    units: str | None
    version: str


class FindingRow(Struct, frozen=True):
    """A pair of bodies that a report lists. Figures are null where they were not computed; _lower
    and _upper are proven bounds. fails: the scene fails by it. file_a, file_b: the mesh files."""

    scene: str
    id: str
    a: str
    b: str
    relation: str
    exact_relation: str | None
    severity: str
    undecided: str | None
    rule: str | None
    fails: bool
    quality: str | None
    depth: float | None
    depth_lower: float | None
    depth_upper: float | None
    thickness: float | None
    thickness_lower: float | None
    thickness_upper: float | None
    distance: float | None
    volume: float | None
    mtv_x: float | None
    mtv_y: float | None
    mtv_z: float | None
    mtv_verified: bool | None
    reason: str | None
    file_a: str
    file_b: str
    units: str | None


class IssueRow(Struct, frozen=True):
    """What is wrong with a scene, a mesh or a check. body, file, line: what it is about."""

    scene: str
    code: str
    severity: str
    body: str | None
    file: str | None
    line: int | None
    message: str


Row = SceneRow | FindingRow | IssueRow
TABLES: dict[str, type[Row]] = {"scenes": SceneRow, "findings": FindingRow, "issues": IssueRow}


def rows(stored: Stored) -> Iterator[tuple[str, Row]]:
    """Each with the name of its table."""
    scene, report = stored.asset.file, stored.asset.report
    yield "scenes", _scene(stored)
    files = {body.id: body.file for body in report.bodies}
    for finding in report.findings:
        yield "findings", _finding(scene, report, finding, files)
    for issue in report.issues:
        yield (
            "issues",
            IssueRow(
                scene,
                issue.code,
                issue.severity,
                issue.body,
                issue.file,
                issue.line,
                issue.message,
            ),
        )


def _scene(stored: Stored) -> SceneRow:
    report = stored.asset.report
    pairs = report.summary.pairs
    severities = [finding.severity for finding in report.findings]
    return SceneRow(
        scene=stored.asset.file,
        files=stored.files,
        verdict=stored.asset.verdict,
        bodies=len(report.bodies),
        pairs=pairs.total,
        decided=pairs.decided,
        pruned=pairs.pruned,
        allowed=pairs.allowed,
        indeterminate=pairs.indeterminate,
        exempt=pairs.exempt,
        errors=severities.count("error"),
        warnings=severities.count("warning"),
        notes=severities.count("note"),
        units=report.units,
        version=report.tool.version,
    )


def _finding(scene: str, report: Report, finding: Finding, files: dict[str, str]) -> FindingRow:
    depth, thickness = _ends(finding.depth_bounds), _ends(finding.thickness_bounds)
    mtv = finding.mtv or (None, None, None)
    return FindingRow(
        scene=scene,
        id=finding.id,
        a=finding.a,
        b=finding.b,
        relation=finding.relation,
        exact_relation=finding.exact_relation,
        severity=finding.severity,
        undecided=finding.undecided,
        rule=finding.rule,
        fails=fails(finding, report.settings.fail_on),
        quality=finding.quality,
        depth=finding.depth,
        depth_lower=depth[0],
        depth_upper=depth[1],
        thickness=finding.thickness,
        thickness_lower=thickness[0],
        thickness_upper=thickness[1],
        distance=finding.distance,
        volume=finding.volume,
        mtv_x=mtv[0],
        mtv_y=mtv[1],
        mtv_z=mtv[2],
        mtv_verified=finding.mtv_verified,
        reason=finding.reason,
        file_a=files[finding.a],
        file_b=files[finding.b],
        units=report.units,
    )


def _ends(bounds: Interval | None) -> tuple[float | None, float | None]:
    return bounds or (None, None)
