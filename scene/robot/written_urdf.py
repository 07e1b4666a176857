"""Writes a URDF whose collision geometry is convex parts. The other elements of the robot stay, and
comments between them, but for relative names of files, if it goes to another folder."""

from __future__ import annotations

import re
from collections import Counter, defaultdict, deque
from collections.abc import Collection, Iterator, Mapping, Sequence
from copy import deepcopy
from itertools import count
from xml.etree import ElementTree

from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.files.xml_tree import Element, guarded_parser, parse_xml
from satcheck.scene.robot.assembly import SceneRobot
from satcheck.scene.robot.reading import parsed

_ABSOLUTE = re.compile(r"[\\/]|\w+:", re.ASCII)


def urdf_of_parts(
    data: bytes,
    robot: SceneRobot,
    lines: Mapping[str, int | None],
    parts: Mapping[str, Sequence[str]],
    geometry: GeometryKind,
    back: str = "",
) -> bytes:
    """Return a URDF with parts for collision geometry.

    data: of the URDF that the robot was read from. lines: id of a body -> line that states it.
    parts: id of a body -> names of the files with its parts, in the frame of its link. A collision
    without parts stays. geometry: what the bodies are; visual geometry replaces the collisions.
    back: the folder of the URDF from that of the new one; "": the same folder. Raises Refused.
    """
    root, data = parsed(robot.robot.file, data)
    if root.tag != "robot":
        root.refuse("no URDF: parts as .urdf are made from one URDF", "unsupported-feature")
    document = _tree(data)
    for each in document.iter() if back else ():
        name = each.get("filename") if each.tag in ("mesh", "texture") else None
        if name and not _ABSOLUTE.match(name):
            each.set("filename", f"{back}/{name}")
    for link, element in zip(root.all("link"), document.findall("robot/link"), strict=True):
        bodies = _bodies_of(link.all(geometry), robot.bodies_of(link.attribute("name")), lines)
        taken = {each.get("name") for each in element.findall("collision")}
        children, indent = list[ElementTree.Element](), element.text
        for child in element:
            made = []
            if child.tag == geometry:
                made = list(_collisions(child, parts.get(next(bodies) or "", ()), taken))
            if child.tag == "visual" and geometry == "visual":
                made = [child, *(made or [_as_collision(child)])]
            elif child.tag != "collision" or geometry == "collision":
                made = made or [child]
            after = child.tail
            for each in made:  # each on a line of its own if the child is
                each.tail = indent if each is not made[-1] else after
            children += made
            indent = after
        element[:] = children
    rows = (ElementTree.tostring(each, "unicode").strip() for each in document)
    return "\n".join(['<?xml version="1.0" encoding="utf-8"?>', *rows, ""]).encode()


def _tree(data: bytes) -> ElementTree.Element:
    """An element with all of the document, as the standard library writes it, with names as they
    stand in the file."""
    builder = ElementTree.TreeBuilder(insert_comments=True, insert_pis=True)
    builder.start("document", {})
    parser = guarded_parser(namespaces=False)
    parser.StartElementHandler, parser.EndElementHandler = builder.start, builder.end
    parser.CharacterDataHandler, parser.CommentHandler = builder.data, builder.comment
    parser.ProcessingInstructionHandler = builder.pi
    parse_xml(parser, data)
    builder.end("document")
    return builder.close()


def _bodies_of(
    shapes: Sequence[Element], bodies: Sequence[str], lines: Mapping[str, int | None]
) -> Iterator[str | None]:
    """Yield for each shape of a link its body, which is known by its line; None: it has none."""
    alike = Counter(shape.line for shape in shapes)
    own: defaultdict[int | None, deque[str]] = defaultdict(deque)
    for body in bodies:
        own[lines.get(body)].append(body)
    for shape in shapes:
        if 0 < len(own[shape.line]) < alike[shape.line]:
            shape.refuse("a shape without geometry in its line: give each a line of its own")
        alike[shape.line] -= 1
        yield own[shape.line].popleft() if own[shape.line] else None


def _collisions(
    stated: ElementTree.Element, files: Sequence[str], taken: Collection[str | None]
) -> Iterator[ElementTree.Element]:
    """Yield a collision for each file, where the link is. taken: names that none of them gets."""
    name = stated.get("name")
    numbers = (number for number in count(1) if f"{name}-{number}" not in taken)
    for number, file in zip(numbers, files, strict=False):
        each = _as_collision(stated)
        for origin in each.findall("origin"):
            each.remove(origin)
        for geometry in each.findall("geometry"):
            geometry[:] = [ElementTree.Element("mesh", filename=file)]
            geometry.text = None
        if name is not None:
            each.set("name", f"{name}-{number}")
        yield each


def _as_collision(stated: ElementTree.Element) -> ElementTree.Element:
    each = deepcopy(stated)
    each.tag = "collision"
    for material in each.findall("material"):
        each.remove(material)
    return each
