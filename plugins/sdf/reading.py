"""Reads SDFormat. A mistake that could move, hide or reshape a body is an error, any other a
warning.

An error inside a <collision>, and a model that cannot be included, refuse only that body. Other
errors refuse the file, with the line.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import starmap
from pathlib import Path

from msgspec.structs import replace

from satcheck.plugins.sdf.contents import Contents, LinkEntry
from satcheck.plugins.sdf.elements import ANY, Part, parts_in
from satcheck.plugins.sdf.frames import WORLD
from satcheck.plugins.sdf.includes import Includes
from satcheck.plugins.sdf.joints import JointEntry, joint_of
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import RawRule
from satcheck.scene.files.readers import File
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.elements import check_mimics
from satcheck.scene.robot.model import (
    Collision,
    Joint,
    Link,
    Robot,
    RobotDocument,
    told_apart,
)
from satcheck.scene.robot.packages import FilePlaces
from satcheck.scene.robot.reading import read_tree
from satcheck.scene.robot.slips import Slips
from satcheck.scene.robot.trees import trees_of


def read_sdf(file: File) -> RobotDocument:
    """Return all links of the file and of the models that it includes as one robot, and warnings.

    Links and joints have their paths as names. Raises Refused with the file, the line and the
    element. No mesh is opened.
    """
    root = read_tree(file.path, file.permitted)
    slips = Slips(file.options["geometry"])
    places = FilePlaces(file.path, file.packages, file.permitted)
    contents = Contents(Includes(places), slips)
    contents.read(root)
    poses = {WORLD: IDENTITY} | {path: contents.frames.world(path) for path in contents.links}
    elements = {joint.path: joint.element for joint in contents.joints}
    joints = [made for joint in contents.joints if (made := _joint(joint, contents, slips))]
    parts = {
        path: parts_in(link.element, path, link.scope, contents.frames, slips)
        if link.refusal is None
        else [Part(link.refusal, ANY)]
        for path, link in contents.links.items()
    }
    collisions, exempted = _exempt(contents.links, parts)
    links = {
        path: Link(
            name=path,
            collisions=collisions[path],
            unused=bool(link.element.all(slips.others)),
            static=link.static,
            rest=poses[path],
        )
        for path, link in contents.links.items()
    }
    still = frozenset((WORLD, *(path for path, link in links.items() if link.static)))

    def note(joint: Joint, cause: str) -> None:
        slips.note("joint-not-moved", elements[joint.name], cause)

    # The world, the canonical link of each outermost model, then all links.
    models = dict.fromkeys(link.model for link in contents.links.values())
    starts = (WORLD, *map(contents.body, models), *contents.links)
    roots, ordered = trees_of(starts, still, poses, joints, note)
    check_mimics([(joint, elements[joint.name]) for joint in ordered])
    robot = Robot(
        name=_name(root),
        file=root.file,
        roots={path: poses[path] for path in roots},
        links=links,
        joints=ordered,
        exempt=(*exempted, *_joined(joints, contents)),
    )
    return RobotDocument(robot=robot, issues=slips.issues())


def _joint(joint: JointEntry, contents: Contents, slips: Slips) -> Joint | None:
    """None: the joint moves nothing, and a warning says so."""
    frames = contents.frames
    if frames.opaque and not all(map(frames.knows, (joint.parent, joint.child))):
        cause = "names a link of a model that is not read"
    else:
        parent, child = contents.body(joint.parent), contents.body(joint.child)
        if parent != child:
            return joint_of(joint, parent, child, frames, slips)
        cause = f"connects {child or 'the world'!r} to itself"
    cause = f"joint {joint.path!r} {cause}: it is ignored"
    slips.note("joint-not-moved", joint.element, cause)
    return None


def _exempt(
    links: Mapping[str, LinkEntry], parts: Mapping[str, Sequence[Part]]
) -> tuple[dict[str, tuple[Collision, ...]], list[RawRule]]:
    """(the collisions of each link, with their groups, the exemptions but for those of joints).
    parts: of each link."""
    apart, exempted = told_apart((part.mask for own in parts.values() for part in own), "SDF")
    reasons: dict[str, str] = {}
    collisions = {}
    for path, link in links.items():
        own = {"static": "SDF: both static"} if link.static else {}
        if not link.self_collide:
            reason = f"SDF: links of model {link.model} without self_collide"
            own[f"model {link.model}"] = reason
        reasons |= own
        collisions[path] = tuple(
            replace(part.collision, groups=(*own, *apart.intersection([part.mask.name])))
            for part in parts[path]
        )
    return collisions, [*exempted, *starmap(RawRule.within, reasons.items())]


def _joined(joints: Iterable[Joint], contents: Contents) -> Iterator[RawRule]:
    """Not with a model that is not read: its other links are checked."""
    unchecked = {WORLD, *contents.frames.opaque}
    for joint in joints:
        if unchecked.isdisjoint((joint.parent, joint.child)):
            yield RawRule(joint.parent, joint.child, f"SDF: joint {joint.name}")


def _name(root: Element) -> str:
    """Of the world, or of the first model."""
    for element in (*root.all("world"), *root.all("model")):
        if name := element.attributes.get("name"):
            return name
    return Path(root.file).stem
