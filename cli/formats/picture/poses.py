"""A report of several poses as pictures show it: the worst finding of each pair with all poses, or
one pose."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np
from msgspec import to_builtins
from msgspec.structs import replace

from satcheck.audit.words import counted, is_listed, rank
from satcheck.cli.formats.picture.moments import Moments
from satcheck.cli.formats.samples import samples_counts, samples_verdict, those_listed
from satcheck.core.errors import SatcheckError
from satcheck.report.report import PairCounts, Report, Summary
from satcheck.scene.bodies import IDENTITY

if TYPE_CHECKING:
    from collections.abc import Iterable

    from satcheck.report.report import Finding
    from satcheck.report.samples import SampledPose, SamplesReport
    from satcheck.scene import Scene

MOST_POSES = 200  # of a page, the first ones and those of the findings


def worst_pose(report: SamplesReport) -> SampledPose | None:
    """The pose with the worst finding."""
    found = [(rank(f), s.number, s) for s in report.samples for f in s.findings if is_listed(f)]
    return min(found, key=lambda each: each[:2])[2] if found else None


def one_pose(report: SamplesReport, scene: Scene, number: int) -> tuple[Report, Scene, Moments]:
    """Raises SatcheckError (`not-drawable`) if the report does not say where bodies stand then."""
    sample = next((each for each in report.samples if each.number == number), None)
    if sample is None or not sample.findings:
        raise SatcheckError("not-drawable", _instead(report, number, sample))
    bodies = (
        replace(body, transform=sample.moved.get(body.id, body.transform))
        for body in as_first(report, scene).bodies
    )
    stated = _stated(report, sample.findings)
    summary = replace(stated.summary, verdict=sample.verdict)
    stated = replace(
        stated, summary=summary, pose=sample.pose, issues=(*sample.issues, *report.issues)
    )
    return stated, replace(scene, bodies=tuple(bodies)), Moments(note=f"pose {number}")


def as_first(report: SamplesReport, scene: Scene) -> Scene:
    """The scene as it stands in the first of the poses."""
    first = {body.id: body.transform for body in report.bodies}
    bodies = (replace(body, transform=first.get(body.id)) for body in scene.bodies)
    return replace(scene, bodies=tuple(bodies))


def all_poses(report: SamplesReport, scene: Scene) -> tuple[Report, Scene, Moments]:
    """The worst finding of each pair, in its pose."""
    scene = as_first(report, scene)
    worst: dict[tuple[str, str], tuple[Finding, SampledPose]] = {}
    for sample in report.samples:
        for finding in filter(is_listed, sample.findings):
            known = worst.get((finding.a, finding.b))
            if known is None or rank(finding) < rank(known[0]):
                worst[finding.a, finding.b] = finding, sample
    about = {sample.number for _, sample in worst.values()}
    found = [sample for sample in report.samples if sample.findings]
    first = found[: max(MOST_POSES - len(about), 0)]
    shown = [s for s in found if s.number in about or s in first]
    at = {sample.number: k for k, sample in enumerate(shown)}
    moved = {id_ for sample in shown for id_ in sample.moved}
    placed = {
        body.id: np.array(
            [s.moved.get(body.id) or body.transform or IDENTITY for s in shown]
        ).reshape(-1, 4, 4)
        for body in scene.bodies
        if body.id in moved
    }
    findings = [
        replace(finding, message=f"Pose {sample.number}: {finding.message}")
        for finding, sample in worst.values()
    ]
    of = {finding.id: at[sample.number] for finding, sample in worst.values()}
    names = tuple(f"pose {sample.number}" for sample in shown)
    note = f"in {counted(report.summary.samples, 'pose')}"
    if report.truncated is not None:
        note = f"in {those_listed(report)}"
    return _stated(report, findings), scene, Moments(names, placed, of, note)


def _instead(report: SamplesReport, number: int, sample: SampledPose | None) -> str:
    """Return why a pose is not drawn, and what draws it where the report has its joints: it does
    not say where bodies stand then."""
    firsts = {pair.first_overlap: pair.first_pose for pair in report.pairs}
    pose = firsts.get(number) if sample is None else sample.pose
    if pose is None:
        return f"pose {number} is not in the report: it has {those_listed(report)}"
    why = "comes after those that the report lists" if sample is None else "has no finding"
    stated = json.dumps(to_builtins(pose))
    return (
        f"pose {number} {why}: --pose '{stated}' -o pose.html draws it, with the files of the check"
    )


def _stated(report: SamplesReport, findings: Iterable[Finding]) -> Report:
    """A report of these findings, for pictures alone."""
    summary, pairs = report.summary, report.summary.pairs
    counts = PairCounts(
        pairs.total,
        pairs.separated,
        pairs.total - pairs.separated - pairs.allowed,
        pairs.allowed,
        0,
    )
    return Report(
        tool=report.tool,
        units=report.units,
        settings=report.settings,
        summary=Summary(summary.verdict, counts, {}),
        message=f"{samples_verdict(report)} {samples_counts(report)}",
        bodies=(),
        rules=report.rules,
        findings=tuple(findings),
        issues=report.issues,
    )
