"""A report as a GLB file, for any viewer: the bodies, translucent, what they share in red, the ways
out as arrows, the balls of the thickness. Bodies that move stand as they do at the first hit, which
is a red point. Of a report with convex parts each has a node. `remarks` in the `extras` of the
scene name overlaps that are not drawn, and why.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from satcheck.cli.formats.picture import drawn_finding, listed, require_drawable
from satcheck.cli.formats.picture.marks import arrow, ball_of, dot
from satcheck.cli.formats.picture.moments import moments_of, sphere_around
from satcheck.cli.formats.picture.shown import marks_of
from satcheck.cli.progress import counting
from satcheck.core.errors import SatcheckError
from satcheck.core.peers import VolumeMeter
from satcheck.report.report import OVERLAPS
from satcheck.scene.written_meshes import Material, Node, glb

if TYPE_CHECKING:
    from satcheck.cli.formats.picture.geometry import Parts
    from satcheck.core import Mesh, Polytope
    from satcheck.report.report import Finding, Report
    from satcheck.scene import Body, Scene

MET = Material("body with findings", (0.16, 0.44, 0.84, 0.35))
OTHER = Material("body", (0.5, 0.54, 0.6, 0.2))
OVERLAP = Material("overlap", (0.86, 0.1, 0.12, 1.0))
PART = Material("part that overlaps", (0.95, 0.45, 0.1, 0.5))
WAY_OUT = Material("way out", (0.05, 0.05, 0.05, 1.0))
HIT = Material("hit", (0.86, 0.1, 0.12, 1.0))
THICKNESS = Material("thickness", (1.0, 0.85, 0.1, 1.0))


def render(report: Report, scene: Scene, parts: Parts | None = None) -> bytes:
    """In world coordinates, in metres where the unit is known. Bodies of one mesh share it. parts:
    convex parts that stand for their bodies."""
    require_drawable(scene)
    findings, moments = listed(report), moments_of(report, scene)
    worst = drawn_finding(report, scene)
    moment = 0 if worst is None else moments.of.get(worst.id, 0)
    scene = moments.scene_at(scene, moment)
    met = {id_ for finding in findings for id_ in (finding.a, finding.b)}
    red, split = _overlapping(findings), parts or {}
    nodes: list[Node] = []
    for body in scene.bodies:
        if body.id in split:
            nodes += _parts(body, split[body.id], red[body.id])
        else:
            material = MET if body.id in met else OTHER
            nodes.append(Node(body.id, body.file.mesh, body.transform, material))
    bodies = {body.id: body for body in scene.bodies}
    drawn = [
        f for f in findings if f.a in bodies and f.b in bodies and moments.of.get(f.id, 0) == moment
    ]
    settings = report.settings
    meter = VolumeMeter(seconds=settings.volume_seconds, megabytes=settings.volume_megabytes)
    remarks: list[str] = []
    with meter:
        for finding in counting(drawn, "pairs", "drawing"):
            nodes += _marks(finding, [bodies[finding.a], bodies[finding.b]], meter, remarks)
    return glb(nodes, report.units, remarks)


def _overlapping(findings: Iterable[Finding]) -> defaultdict[str, set[int]]:
    """Return body -> the numbers of its parts that overlap a part of another."""
    red: defaultdict[str, set[int]] = defaultdict(set)
    for finding in findings:
        if finding.part_pairs is not None:
            own, other = finding.part_pairs.overlapping_parts()
            red[finding.a].update(own)
            red[finding.b].update(other)
    return red


def _parts(body: Body, parts: Sequence[Polytope], red: set[int]) -> Iterator[Node]:
    for number, part in enumerate(parts, 1):
        material = PART if number in red else MET
        yield Node(f"{body.id}-{number}", part.to_mesh(), body.transform, material)


def _marks(
    finding: Finding, pair: list[Body], meter: VolumeMeter, remarks: list[str]
) -> Iterator[Node]:
    found, radius = marks_of(finding, pair), sphere_around(pair)[1]
    marks = {
        WAY_OUT: None if found.way is None else arrow(*found.way, radius),
        HIT: None if found.hit is None else dot(found.hit, radius),
        THICKNESS: ball_of(finding),
    }
    if finding.at_rest in OVERLAPS:
        try:
            marks[OVERLAP] = _overlap(pair, meter)
        except SatcheckError as error:
            remarks.append(f"no overlap of {finding.a} and {finding.b} is drawn: {error}")
    for material, mesh in marks.items():
        if mesh is not None:
            yield Node(f"{material.name}: {finding.a} and {finding.b}", mesh, None, material)


def _overlap(pair: list[Body], meter: VolumeMeter) -> Mesh | None:
    """None: too small for manifold3d."""
    for body in pair:
        if not body.file.health.solid:
            raise SatcheckError("volume-refused", f"{body.id} is not closed")
    a, b = (body.world_mesh() for body in pair)
    return meter.common(a, b)
