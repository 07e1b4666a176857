"""A document with joints, such as a USD file, as a robot: its rigid bodies are links.

The frames of all links are those of the world while the links stand as the file places them, so the
bodies then stand exactly where the file places them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, Body
from satcheck.scene.document import Document, RawJoint
from satcheck.scene.issue import Issue, issue
from satcheck.scene.robot.assembly import RobotBody, SceneRobot
from satcheck.scene.robot.joint_forest import Edge, Moves, trees_of
from satcheck.scene.robot.model import Limits, Link, Robot
from satcheck.scene.units import InOneUnit, ratio

_WORLD = ""


def robots_of_documents(
    documents: Iterable[tuple[Document, Mapping[str, str]]],
    bodies: Sequence[Body],
    common: InOneUnit,
) -> tuple[list[SceneRobot], list[Issue]]:
    """The robots, and issues. documents: with joints that move, and id of a body -> its rigid body.
    bodies: of the scene, in the common unit, as the files place them."""
    metre = ratio("m", common.unit) if common.unit else 1.0
    robots: list[SceneRobot] = []
    issues: list[Issue] = []
    for document, links in documents:
        unit = common.scales.get(document.path, 1.0)
        robot, remarks = _robot(document, links, bodies, metre, unit)
        robots.append(robot)
        issues += remarks
    return robots, issues


def _robot(
    document: Document,
    links: Mapping[str, str],
    bodies: Sequence[Body],
    metre: float,
    unit: float,
) -> tuple[SceneRobot, list[Issue]]:
    """metre: in the unit of the scene. unit: that of the document, in the unit of the scene."""
    path = document.path
    edges = [_edge(joint, metre, unit) for joint in document.joints]
    ends = [end for edge in edges for end in (edge.parent, edge.child)]
    names = list(dict.fromkeys((_WORLD, *ends)))
    poses = dict.fromkeys(names, IDENTITY)
    said: list[Issue] = []

    def note(_: Edge, cause: str) -> None:
        said.append(issue("joint-not-moved", cause, file=path))

    trees = trees_of(names, frozenset((_WORLD,)), poses, edges, note)
    robot = Robot(
        name=path,
        file=path,
        roots=dict.fromkeys(trees.roots, IDENTITY),
        links={name: Link(name, (), unused=False, rest=IDENTITY) for name in names},
        joints=trees.joints,
    )
    own = tuple(
        RobotBody(body.id, links[body.id], body.transform or IDENTITY)
        for body in bodies
        if links.get(body.id) in poses
    )
    return SceneRobot(robot, own, loose=True), said


def _edge(joint: RawJoint, metre: float, unit: float) -> Edge:
    length = metre if joint.kind == "prismatic" else 1.0
    x, y, z = joint.axis
    moves = Moves(
        kind="continuous" if joint.kind == "revolute" and joint.limits is None else joint.kind,
        axis=(x * length, y * length, z * length),
        limits=None if joint.limits is None else Limits(*joint.limits),
        rest=joint.rest,
    )
    ends = joint.parent or _WORLD, joint.child or _WORLD
    return Edge(joint.name, *ends, _scaled(joint.frame, unit), moves)


def _scaled(pose: Transform, unit: float) -> Transform:
    return tuple(value * unit if k % 4 == 3 and k < 12 else value for k, value in enumerate(pose))
