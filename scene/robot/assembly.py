"""A robot in a scene: the bodies of its links, the pairs that may touch, and the placements."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform, compose
from satcheck.scene.bodies import IDENTITY, Entry, Scene
from satcheck.scene.document import HULL_MARK, Document, FilePart, Item, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.issue import Issue, issue
from satcheck.scene.robot.kinematics import link_poses, scaled
from satcheck.scene.robot.model import (
    Collision,
    Link,
    MeshReference,
    Robot,
    State,
)
from satcheck.scene.robot.packages import FilePlaces
from satcheck.scene.robot.poses import Pose, settle
from satcheck.scene.robot.srdf import Srdf
from satcheck.scene.words import listed

UNITS = "m"  # of every URDF, SDFormat and MJCF file


class RobotBody(Struct, frozen=True):
    """A body of a link of a robot, readable or not. groups: as the robot names them."""

    id: str
    link: str
    offset: Transform
    groups: tuple[str, ...] = ()


class SceneRobot(Struct, frozen=True):
    """A robot, its bodies, and its SRDF. groups: as the robot names them -> as the check does.
    loose: its bodies stand where a document places them, so they may be moved without it."""

    robot: Robot
    bodies: tuple[RobotBody, ...]
    srdf: Srdf | None = None
    groups: Mapping[str, str] = {}
    loose: bool = False

    @property
    def states(self) -> tuple[State, ...]:
        return (*self.robot.states, *(self.srdf.states if self.srdf else ()))

    def bodies_of(self, link: str) -> list[str]:
        return [body.id for body in self.bodies if body.link == link]

    def by_link(self) -> dict[str, list[str]]:
        """The bodies of each link that has any."""
        links: dict[str, list[str]] = {}
        for body in self.bodies:
            links.setdefault(body.link, []).append(body.id)
        return links

    @property
    def pairs_within_links(self) -> int:
        """The number of pairs of bodies on the same link. They are never checked."""
        return sum(n * (n - 1) // 2 for n in Counter(body.link for body in self.bodies).values())

    def neighbours(self) -> list[tuple[str, str]]:
        """Pairs (parent, child) of links with bodies that are connected by a joint. Links without
        bodies between them count as part of the joint."""
        solid = {body.link for body in self.bodies}
        carrier = {joint.child: joint.parent for joint in self.robot.joints}
        pairs = []
        for link in (link for link in self.robot.links if link in solid):
            above = carrier.get(link)
            while above is not None and above not in solid:
                above = carrier.get(above)
            if above is not None:
                pairs.append((above, link))
        return pairs


def document_of_robot(robot: Robot, places: FilePlaces, issues: Sequence[Issue]) -> Document:
    """Return a document with an item for each <collision>, and with these issues.

    The id of an item is the name of the link; if the link has several, "link/name" or
    "link/number". Items that fail for the same cause share one message, which states their number.
    """
    collisions = [
        (link, collision, number, _shape(collision, places.of(collision.file or robot.file)))
        for link in robot.links.values()
        for number, collision in enumerate(link.collisions, 1)
    ]
    lost: dict[tuple[str, str], list[Collision]] = {}
    for _, collision, _, shape in collisions:
        if isinstance(shape, Refused):
            lost.setdefault((shape.code, shape.message), []).append(collision)
    items = []
    for link, collision, number, shape in collisions:
        if isinstance(shape, Refused):
            shape = _placed(shape, lost[shape.code, shape.message])
        item = Item(
            id=_part_id(link, collision, number),
            link=link.name,
            transform=_offset(collision),
            shape=shape,
            static=link.static,
            groups=collision.groups,
            entry=Entry(collision.file or robot.file, line=collision.line),
        )
        items.append(item)
    return Document(
        path=robot.file,
        name=robot.name,
        kind="robot",
        units=UNITS,
        items=tuple(items),
        issues=(*issues, *_bare_links(robot)),
        robot=robot,
    )


def _placed(cause: Refused, lost: Sequence[Collision]) -> Refused:
    """The cause, with the number of bodies that it affects, and its first place in the file."""
    first, number = lost[0], len(lost)
    place = f"line {first.line}" if first.line else "the file"
    if isinstance(first.geometry, MeshReference):
        place += f": {first.geometry.uri!r}" if number == 1 else f" ({first.geometry.uri})"
    start = place if number == 1 else f"{number} bodies, the first in {place}"
    return Refused(cause.code, f"{start}: {cause.message}")


def _bare_links(robot: Robot) -> list[Issue]:
    """A note on links that have only geometry of the kind that is not checked."""
    bare = [link.name for link in robot.links.values() if link.unused and not link.collisions]
    if not bare:
        return []
    have = "link has" if len(bare) == 1 else "links have"
    others = "visual" if robot.geometry == "collision" else "collision"
    message = (
        f"{len(bare)} {have} {others} geometry and no {robot.geometry} geometry, so no body is "
        f"checked: {listed(bare)}"
    )
    return [issue("no-collision-geometry", message, file=robot.file)]


def with_srdfs(robots: Sequence[SceneRobot], srdfs: Iterable[Srdf]) -> list[SceneRobot]:
    """Each robot with its SRDF: the SRDF with its name, or the only SRDF if there is only one
    robot.

    Raises Refused if an SRDF has no robot, or if a robot has two SRDFs.
    """
    matched = list(robots)
    for srdf in srdfs:
        named = [k for k, robot in enumerate(matched) if robot.robot.name == srdf.robot]
        if not named and len(matched) == 1:
            named = [0]
        if not named:
            names = ", ".join(robot.robot.name for robot in matched) or "no URDF is given"
            message = f"about robot {srdf.robot!r}, which is not given ({names})"
            raise Refused("bad-robot", message, file=srdf.file)
        for k in named:
            if matched[k].srdf is not None:
                message = f"a second SRDF about robot {matched[k].robot.name!r}"
                raise Refused("bad-robot", message, file=srdf.file)
            matched[k] = replace(matched[k], srdf=srdf)
    return matched


def link_frames(scene: Scene, joints: Mapping[str, Any]) -> list[dict[str, Transform]]:
    """Of each robot: link -> its pose. Its entries are arrays over many poses where those of the
    joints are."""
    return [link_poses(robot.robot, joints) for robot in scene.robots]


def body_poses(scene: Scene, frames: Sequence[Mapping[str, Transform]]) -> dict[str, Transform]:
    """The placement of each body of a link. frames: from `link_frames`."""
    return {
        body.id: compose(links[body.link], body.offset)
        for robot, links in zip(scene.robots, frames, strict=True)
        for body in robot.bodies
    }


def posed(scene: Scene, pose: Pose) -> Scene:
    """The scene with its robots in this pose: new transforms, the same meshes. Bodies that do not
    move are the same objects.

    pose: joint -> values; `poses.settle` says what happens to other joints, and which values are
    refused. The result has the complete posture and the issues about it.
    """
    posture = settle([robot.robot for robot in scene.robots], pose)
    transforms = body_poses(scene, link_frames(scene, posture.joints))
    earlier = scene.posture.issues if scene.posture else ()
    return replace(
        scene,
        bodies=tuple(
            body
            if body.id not in transforms or transforms[body.id] == (body.transform or IDENTITY)
            else replace(body, transform=transforms[body.id])
            for body in scene.bodies
        ),
        issues=(*(remark for remark in scene.issues if remark not in earlier), *posture.issues),
        posture=posture,
    )


def pose_of_states(scene: Scene, names: Iterable[str]) -> Pose:
    """The named states combined. Raises SatcheckError if two give a joint different values, or if a
    state names a joint that the robots do not have."""
    from satcheck.scene.robot.poses import check_state, state_named

    states = [state for robot in scene.robots for state in robot.states]
    pose: dict[str, tuple[float, ...]] = {}
    for name in names:
        state = state_named(name, states)
        check_state(state, [robot.robot for robot in scene.robots])
        for joint, values in state.joints.items():
            if pose.setdefault(joint, values) != values:
                raise SatcheckError("bad-pose", f"two states give joint {joint!r} different values")
    return pose


def _part_id(link: Link, collision: Collision, number: int) -> str:
    if len(link.collisions) == 1:
        return link.name
    return f"{link.name}/{collision.name or number}"


def _offset(collision: Collision) -> Transform:
    if isinstance(collision.geometry, MeshReference):
        placing = scaled(collision.origin, collision.geometry.scale)
        start = collision.geometry.start
        return placing if start == IDENTITY else compose(placing, start)
    return collision.origin


def _shape(collision: Collision, places: FilePlaces) -> FilePart | Primitive | Refused:
    match collision.geometry:
        case MeshReference(uri, part=part, hull=hull):
            try:
                found = places.locate(uri)
            except Refused as error:
                return error
            return FilePart(
                found.as_posix(), str(found), f"{part or ''}{HULL_MARK}" if hull else part
            )
        case Refusal(code, reason):
            return Refused(code, reason)
    return collision.geometry
