"""Orders the joints of SDFormat files, and of documents such as USD files, into trees.

A joint may name its links in either order, and joints may close loops. A joint of a loop cannot
move alone: it stays as the file places it, and a warning says so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from msgspec.structs import replace

from satcheck.core.transform import Transform, compose
from satcheck.scene.bodies import IDENTITY, Body
from satcheck.scene.document import Document, RawJoint
from satcheck.scene.issue import Issue, issue
from satcheck.scene.robot.assembly import RobotBody, SceneRobot
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.robot.model import Joint, Limits, Link, Robot
from satcheck.scene.units import InOneUnit, ratio
from satcheck.scene.words import listed

WORLD = ""
Note = Callable[[Joint, str], None]


def trees_of(
    starts: Iterable[str],
    still: frozenset[str],
    poses: Mapping[str, Transform],
    joints: Iterable[Joint],
    note: Note,
) -> tuple[list[str], tuple[Joint, ...]]:
    """Return (the links that no joint carries, the joints, parents first).

    starts: all links, and the world, in the order in which they become roots. still: the world and
    links of static models. poses: of links in the world. joints: their parent may be the link that
    they carry; `origin` is their pose in the world, where the links stand. note: takes the message
    about a loop that this joint closes.
    """
    carriers, roots, loops = _walk(list(starts), still, joints)
    stuck = _stuck(carriers, loops, note)
    rooted = (_rooted(joint, link, poses, joint.name in stuck) for link, joint in carriers.items())
    return roots, tuple(rooted)


def _walk(
    starts: Sequence[str], still: frozenset[str], joints: Iterable[Joint]
) -> tuple[dict[str, Joint], list[str], list[Joint]]:
    """(link -> the joint that carries it, roots, joints that close loops)"""
    around: dict[str, list[Joint]] = {}
    for joint in joints:
        for link in (joint.parent, joint.child):
            around.setdefault(link, []).append(joint)
    carriers: dict[str, Joint] = {}
    roots: list[str] = []
    reached: set[str] = set()
    used: set[str] = set()
    loops: list[Joint] = []
    for start in starts:
        if start in reached:
            continue
        waiting = [link for link in starts if link in still] if start in still else [start]
        roots += waiting
        reached.update(waiting)
        for link in waiting:  # grows
            for joint in around.get(link, ()):
                other = _other(joint, link)
                if joint.name in used:
                    continue
                used.add(joint.name)
                if other in reached:
                    loops.append(joint)
                else:
                    reached.add(other)
                    carriers[other] = joint
                    waiting.append(other)
    return carriers, roots, loops


def _other(joint: Joint, link: str) -> str:
    return joint.parent if link == joint.child else joint.child


def _stuck(carriers: Mapping[str, Joint], loops: Iterable[Joint], note: Note) -> set[str]:
    """The joints that are part of a loop."""
    stuck: set[str] = set()
    for joint in loops:
        ways = [list(_way(link, carriers)) for link in (joint.parent, joint.child)]
        shared = {step.name for step in ways[0]} & {step.name for step in ways[1]}
        loop = [joint, *(step for way in ways for step in way if step.name not in shared)]
        stuck.update(step.name for step in loop)
        moving = [step.name for step in loop if step.kind != "fixed"]
        if moving:
            cause = "joints of a loop are not moved, its links stay as the file places them: "
            note(joint, cause + listed(moving))
    return stuck


def _way(link: str, carriers: Mapping[str, Joint]) -> Iterator[Joint]:
    """The joints from the link to its root."""
    while link in carriers:
        yield carriers[link]
        link = _other(carriers[link], link)


def _rooted(joint: Joint, link: str, poses: Mapping[str, Transform], stuck: bool) -> Joint:
    """The joint that carries the link. If this is the parent of the joint, it moves against the
    axis."""
    carrier = _other(joint, link)
    x, y, z = joint.axis
    placed = replace(
        joint,
        parent=carrier,
        child=link,
        origin=compose(inverse(poses[carrier]), joint.origin),
        axis=joint.axis if link == joint.child else (-x, -y, -z),
        child_origin=compose(inverse(joint.origin), poses[link]),
        stands_at_zero=True,
    )
    if stuck:
        return replace(placed, kind="fixed", limits=None, mimic=None, reference=())
    return placed


def robots_of_documents(
    documents: Iterable[tuple[Document, Mapping[str, str]]],
    bodies: Sequence[Body],
    common: InOneUnit,
) -> tuple[list[SceneRobot], list[Issue]]:
    """Return the robots, and issues. documents: with joints that move, and id of a body -> its
    rigid body. bodies: of the scene, in the common unit, as the files place them.

    The frames of all links are those of the world while the links stand as the file places them, so
    the bodies then stand exactly where the file places them.
    """
    metre = ratio("m", common.unit) if common.unit else 1.0
    robots: list[SceneRobot] = []
    issues: list[Issue] = []
    for document, links in documents:
        path, unit = document.path, common.scales.get(document.path, 1.0)
        joints = [_joint(joint, metre, unit) for joint in document.joints]
        ends = (end for joint in joints for end in (joint.parent, joint.child))
        poses = dict.fromkeys((WORLD, *ends), IDENTITY)

        def note(_: Joint, cause: str, path: str = path) -> None:
            issues.append(issue("joint-not-moved", cause, file=path))

        roots, ordered = trees_of(poses, frozenset((WORLD,)), poses, joints, note)
        robot = Robot(
            name=path,
            file=path,
            roots=dict.fromkeys(roots, IDENTITY),
            links={name: Link(name, (), unused=False, rest=IDENTITY) for name in poses},
            joints=ordered,
        )
        own = tuple(
            RobotBody(body.id, links[body.id], body.transform or IDENTITY)
            for body in bodies
            if links.get(body.id) in poses
        )
        robots.append(SceneRobot(robot, own, loose=True))
    return robots, issues


def _joint(joint: RawJoint, metre: float, unit: float) -> Joint:
    """metre: in the unit of the scene. unit: that of the document, in the unit of the scene. The
    axis of a prismatic joint is as long as a metre."""
    length = metre if joint.kind == "prismatic" else 1.0
    x, y, z = joint.axis
    return Joint(
        name=joint.name,
        kind="continuous" if joint.kind == "revolute" and joint.limits is None else joint.kind,
        parent=joint.parent or WORLD,
        child=joint.child or WORLD,
        origin=tuple(v * unit if k in (3, 7, 11) else v for k, v in enumerate(joint.frame)),
        axis=(x * length, y * length, z * length),
        limits=None if joint.limits is None else Limits(*joint.limits),
        reference=(joint.rest,) if joint.rest and joint.kind != "fixed" else (),
    )
