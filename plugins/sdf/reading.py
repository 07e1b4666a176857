"""Reads SDFormat. A mistake that could move, hide or reshape a body is an error, any other a
warning.

An error inside a <collision>, and a model that cannot be included, refuse only that body. Other
errors refuse the file, with the line.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from satcheck.core.transform import Transform
from satcheck.plugins.sdf.contents import Contents, LinkEntry
from satcheck.plugins.sdf.exemptions import exempt
from satcheck.plugins.sdf.frames import WORLD
from satcheck.plugins.sdf.includes import Includes
from satcheck.plugins.sdf.joints import JointEntry, moves_of
from satcheck.plugins.sdf.parts import ANY, Part, parts_in
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.files.readers import GeometryKind, RobotFile
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.issue import Issue
from satcheck.scene.robot.joint_forest import Edge, trees_of
from satcheck.scene.robot.joint_tree import check_mimics
from satcheck.scene.robot.model import Exemption, Link, Robot
from satcheck.scene.robot.slips import Slips


def read_sdf(root: Element, file: RobotFile) -> tuple[Robot, tuple[Issue, ...]]:
    """Return all links of the file and of the models that it includes as one robot, and warnings.

    root: the outermost element. Links and joints have their paths as names. Raises Refused
    with the file, the line and the element. No mesh is opened.
    """
    includes, geometry = Includes(file.places), file.geometry
    slips = Slips(geometry)
    contents = Contents(includes, slips, geometry)
    contents.read(root)
    poses = {WORLD: IDENTITY} | {path: contents.frames.world(path) for path in contents.links}
    edges = [edge for joint in contents.joints if (edge := _edge(joint, contents, slips))]
    parts = {path: _parts(path, contents, slips, geometry) for path in contents.links}
    contacts = {path: link.contacts for path, link in contents.links.items()}
    collisions, exempted = exempt(contacts, parts, _joined(edges, contents))
    links = {
        path: Link(
            name=path,
            collisions=collisions[path],
            unused=bool(link.element.all(slips.others)),
            static=link.contacts.static,
            rest=poses[path],
        )
        for path, link in contents.links.items()
    }
    still = frozenset((WORLD, *(path for path, link in links.items() if link.static)))
    elements = {joint.path: joint.element for joint in contents.joints}

    def note(edge: Edge, cause: str) -> None:
        slips.note("joint-not-moved", elements[edge.path], cause)

    trees = trees_of([*_starts(contents)], still, poses, edges, note)
    check_mimics([(joint, elements[joint.name]) for joint in trees.joints])
    roots: dict[str, Transform] = {path: poses[path] for path in trees.roots}
    robot = Robot(_name(root), root.file, roots, links, trees.joints, exempted, geometry)
    return robot, slips.issues()


def _parts(path: str, contents: Contents, slips: Slips, geometry: GeometryKind) -> list[Part]:
    link: LinkEntry = contents.links[path]
    if link.refusal is not None:
        return [Part(link.refusal, ANY)]
    return parts_in(link.element, path, link.scope, contents.frames, slips, geometry)


def _edge(joint: JointEntry, contents: Contents, slips: Slips) -> Edge | None:
    """None: the joint moves nothing, and a warning says so."""
    frames = contents.frames
    if frames.opaque and not all(map(frames.knows, (joint.parent, joint.child))):
        cause = "names a link of a model that is not read"
    else:
        parent, child = contents.body(joint.parent), contents.body(joint.child)
        if parent != child:
            moves = moves_of(joint, frames, slips)
            return Edge(joint.path, parent, child, frames.world(joint.path), moves)
        cause = f"connects {child or 'the world'!r} to itself"
    cause = f"joint {joint.path!r} {cause}: it is ignored"
    slips.note("joint-not-moved", joint.element, cause)
    return None


def _joined(edges: list[Edge], contents: Contents) -> Iterator[Exemption]:
    """Not with a model that is not read: its other links are checked."""
    unchecked = {WORLD, *contents.frames.opaque}
    for edge in edges:
        if unchecked.isdisjoint((edge.parent, edge.child)):
            yield Exemption(edge.parent, edge.child, f"SDF: joint {edge.path}")


def _starts(contents: Contents) -> Iterator[str]:
    """The world, the canonical link of each outermost model, then all links."""
    yield WORLD
    for model in dict.fromkeys(link.contacts.model for link in contents.links.values()):
        yield contents.body(model)
    yield from contents.links


def _name(root: Element) -> str:
    """Of the world, or of the first model."""
    for element in (*root.all("world"), *root.all("model")):
        if name := element.attributes.get("name"):
            return name
    return Path(root.file).stem
