"""What a picture shows of a finding, the page and the image alike: where its bodies stand, its
marks, the labels with their figures, and the viewpoint. All of it is in the world."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from satcheck import core
from satcheck.audit.messages import measured
from satcheck.audit.stages.contacts import contacts_of
from satcheck.audit.words import (
    between_poses,
    figure,
    is_hit,
    number,
    place,
    short_names,
    with_unit,
)
from satcheck.cli.formats.picture.marks import deciding_rim, dot
from satcheck.cli.formats.picture.moments import boxes_of, matrix_of, sphere_around
from satcheck.cli.formats.picture.viewpoint import Viewpoint, Viewpoints
from satcheck.report.colliders import OF_COLLIDERS
from satcheck.report.report import OVERLAPS
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from satcheck.cli.formats.picture.marks import Rim
    from satcheck.cli.formats.picture.moments import Moments
    from satcheck.report.report import Finding, Report
    from satcheck.scene import Body, Scene

    Floats = npt.NDArray[np.float64]
    Kind = Literal["a", "b", "arrow", "gap", "ball", "hit", "hole"]

MOST_POINTS = 20_000  # of the lines of a pair
# A body is named where its surface is nearest to a point so far from the middle, of the radius.
_WITHIN = 0.7


class Label(NamedTuple):
    """at: in the world; of a body, "a" or "b", a point of its mesh in coordinates of its file."""

    text: str
    at: Floats
    kind: Kind


class Marks(NamedTuple):
    """way: start and translation of the arrow. gap: the nearest points of A and B. hit: where
    moving bodies meet first. rim: of the hole that decides. lines: where the surfaces cross, and
    the outlines of patches in which both lie; a closed line repeats its start."""

    way: tuple[Floats, Floats] | None
    gap: tuple[Floats, Floats] | None
    hit: Floats | None
    rim: Rim | None = None
    lines: Sequence[Floats] = ()

    def points(self) -> list[Floats]:
        """That are to be seen."""
        way = [] if self.way is None else [self.way[0], self.way[0] + self.way[1]]
        rim = [] if self.rim is None else [point for line in self.rim.lines for point in line]
        return [*way, *(self.gap or ()), *([] if self.hit is None else [self.hit]), *rim]


class Shown(NamedTuple):
    """pair: as they stand at the moment. place: where to look."""

    finding: Finding
    moment: int
    pair: list[Body]
    place: Floats
    marks: Marks
    labels: list[Label]
    view: Viewpoint


class Shows:
    """Findings of a report about a scene, whose bodies can be drawn."""

    def __init__(self, report: Report, scene: Scene, moments: Moments, up: str) -> None:
        self._unit = unit_of(report.units)
        self._scene, self._moments, self._up = scene, moments, up
        self._planar = report.settings.planar is not None
        self._viewpoints = Viewpoints(up)
        self._scenes: dict[int, Scene] = {}
        self._surfaces: dict[str, core.Surface] = {}

    def scene_at(self, moment: int) -> Scene:
        if moment not in self._scenes:
            self._scenes = {moment: self._moments.scene_at(self._scene, moment)}
            self._surfaces = {}
        return self._scenes[moment]

    def of(self, finding: Finding, *, closely: bool = True) -> Shown:
        """closely: rays choose the viewpoint, holes and the lines where surfaces meet are searched,
        and names stand on bodies."""
        moment = self._moments.of.get(finding.id, 0)
        bodies = self.scene_at(moment).bodies
        by_id = {body.id: body for body in bodies}
        pair = [by_id[finding.a], by_id[finding.b]]
        marks = marks_of(finding, pair)
        if closely and not self._planar:
            meet = finding.at_rest == "touching" or finding.at_rest in OVERLAPS
            lines = _meeting_lines(*map(self._surface, pair)) if meet else ()
            marks = marks._replace(rim=deciding_rim(finding, pair, self._surface), lines=lines)
        if closely and moment:
            marks = marks._replace(gap=self._gap_then(finding, pair))
        seen, across = _place(finding, pair, marks), self._across(marks, finding, moment)
        view = self._viewpoints.of_pair(
            bodies,
            pair,
            seen,
            across,
            through=marks.rim and marks.rim.normal,
            also=marks.points(),
            tested=closely,
        )
        labels = [
            *self._names(pair, view, closely=closely),
            *self._figures(finding, marks, view.towards),
        ]
        return Shown(finding, moment, pair, seen, marks, labels, view)

    def _surface(self, body: Body) -> core.Surface:
        """As it stands at the moment of the last scene."""
        if body.id not in self._surfaces:
            self._surfaces[body.id] = core.Surface(body.world_mesh(), body.file.health.solid)
        return self._surfaces[body.id]

    def _gap_then(self, finding: Finding, pair: list[Body]) -> tuple[Floats, Floats] | None:
        """At the moment of the pair, for which the finding has no points."""
        if finding.at_rest in OVERLAPS or is_hit(finding):
            return None
        a, b = map(self._surface, pair)
        nearest = core.mesh_distance(a, b)
        return np.array(nearest.witness_a), np.array(nearest.witness_b)

    def _across(self, marks: Marks, finding: Finding, moment: int) -> Floats | None:
        """What the picture looks across: the way out, the gap, or how bodies moved before a hit."""
        if marks.way is not None:
            return marks.way[1]
        if marks.gap is not None:
            return marks.gap[1] - marks.gap[0]
        if marks.hit is not None and moment > 0:
            point, placed = np.append(marks.hit, 1.0), self._moments.placed
            moved = np.zeros(4)
            for sign, id_ in ((1.0, finding.a), (-1.0, finding.b)):
                if id_ in placed:
                    now, before = placed[id_][moment], placed[id_][moment - 1]
                    moved += sign * (point - before @ np.linalg.solve(now, point))
            return moved[:3]
        return None if finding.normal is None else np.array(finding.normal)

    def _names(self, pair: list[Body], view: Viewpoint, *, closely: bool) -> list[Label]:
        names = short_names(*(body.id for body in pair))
        centres = [sphere_around([body])[0] for body in pair]
        across = view.rows(self._up)[:2]
        away = across @ (centres[0] - centres[1])
        away = (away if away.any() else np.array([0.0, 1.0])) @ across
        away *= _WITHIN * view.radius / np.linalg.norm(away)
        kinds: tuple[Kind, Kind] = ("a", "b")
        return [
            Label(name, self._anchor(body, view.target + sign * away, closely=closely), kind)
            for name, body, sign, kind in zip(names, pair, (1.0, -1.0), kinds, strict=True)
        ]

    def _anchor(self, body: Body, near: Floats, *, closely: bool) -> Floats:
        """A point of the mesh, away from the other body; in coordinates of the file."""
        if not closely:
            first: Floats = np.asarray(body.file.mesh.vertices)[0]
            return first
        spot = core.Surface(dot(near, 1e-3 * sphere_around([body])[1]), True)
        point = np.append(core.mesh_distance(spot, self._surface(body)).witness_b, 1.0)
        placed: Floats = np.linalg.solve(matrix_of(body), point)[:3]
        return placed

    def _figures(self, finding: Finding, marks: Marks, towards: Floats) -> list[Label]:
        unit, labels = self._unit, []
        if finding.ball is not None:
            text = f"thickness {figure(finding.thickness_bounds, unit)}"
            labels.append(Label(text, np.array(finding.ball.centre), "ball"))
        if marks.way is not None:
            start, way = marks.way
            moved = f"move {short_names(finding.a, finding.b)[0]}"
            text = f"{moved} by {figure(finding.depth_bounds, unit)}"
            labels.append(Label(text, start + way, "arrow"))
        if marks.gap is not None:
            length = float(np.linalg.norm(marks.gap[1] - marks.gap[0]))
            text = f"gap {with_unit(number(length), unit)}"
            text = measured(finding, unit) if finding.rule in OF_COLLIDERS else text
            labels.append(Label(text, (marks.gap[0] + marks.gap[1]) / 2, "gap"))
        if marks.hit is not None and finding.motion is not None:
            at, poses = finding.motion.at, finding.motion.poses
            text = f"hit at {', '.join(place(each, unit) for each in at)}"
            text += "" if poses is None else between_poses(*poses)
            labels.append(Label(text, marks.hit, "hit"))
        if marks.rim is not None:
            wide = with_unit(number(marks.rim.diameter), unit)
            hole = f"{marks.rim.which} of {short_names(marks.rim.body)[0]}"
            text = f"{hole}, {wide} across: its fill decides"
            rim = np.concatenate(marks.rim.lines)
            labels.append(Label(text, rim[int((rim @ towards).argmax())], "hole"))
        return labels


def marks_of(finding: Finding, pair: list[Body]) -> Marks:
    """Those that the finding states. The way out starts where the bodies overlap."""
    way, gap, hit = None, None, None
    witness, is_apart = finding.witness, finding.at_rest not in OVERLAPS
    if finding.mtv is not None and any(finding.mtv):
        start = _shared(pair) if witness is None else np.array(witness.a)
        start = start if finding.ball is None else np.array(finding.ball.centre)
        way = start, np.array(finding.mtv)
    if is_apart and finding.distance and witness is not None:
        gap = np.array(witness.a), np.array(witness.b)
    if is_apart and is_hit(finding) and finding.motion is not None:
        hit = None if finding.motion.point is None else np.array(finding.motion.point)
    return Marks(way, gap, hit)


def placed_point(body: Body, point: Floats) -> Floats:
    """A point of its mesh in the world."""
    placed: Floats = (matrix_of(body) @ np.append(point, 1.0))[:3]
    return placed


def _meeting_lines(a: core.Surface, b: core.Surface) -> list[Floats]:
    contacts = contacts_of(a, b, MOST_POINTS)
    if isinstance(contacts, str):
        return []
    curves = [[*curve.points, *curve.points[: curve.closed]] for curve in contacts.curves]
    outlines = (outline for patch in contacts.patches for outline in patch.outlines)
    return [np.array(line) for line in (*curves, *([*line, line[0]] for line in outlines))]


def _place(finding: Finding, pair: list[Body], marks: Marks) -> Floats:
    """Where to look."""
    if marks.rim is not None:
        return marks.rim.centre
    if marks.hit is not None:
        return marks.hit
    if finding.ball is not None and finding.at_rest in OVERLAPS:
        return np.array(finding.ball.centre)
    if finding.witness is not None:
        between: Floats = (np.array(finding.witness.a) + np.array(finding.witness.b)) / 2
        return between
    return _shared(pair)


def _shared(pair: list[Body]) -> Floats:
    """The middle of what the boxes of the bodies share, or of what is between them."""
    boxes = boxes_of(pair)
    middle: Floats = (boxes[:, 0].max(axis=0) + boxes[:, 1].min(axis=0)) / 2
    return middle
