"""Writes a URDF whose collision geometry is convex parts. All else stays, comments too, but for
relative names of files, if it goes to another folder."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import count
from typing import Any
from xml.dom import expatbuilder

from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.robot.assembly import SceneRobot
from satcheck.scene.robot.reading import parsed

_ABSOLUTE = re.compile(r"[\\/]|\w+:")
_Node = Any  # by its stubs each child may be of any kind


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
    document: _Node = expatbuilder.parseString(data, namespaces=False)
    for tag in ("mesh", "texture") if back else ():
        for each in document.getElementsByTagName(tag):
            if (name := each.getAttribute("filename")) and not _ABSOLUTE.match(name):
                each.setAttribute("filename", f"{back}/{name}")
    links = _all(document.documentElement, "link")
    for link, node in zip(root.all("link"), links, strict=True):
        bodies, replaced = robot.bodies_of(link.attribute("name")), _all(node, "collision")
        taken = {each.getAttribute("name") for each in replaced}
        for shape, stated in zip(link.all(geometry), _all(node, geometry), strict=True):
            alike = [each for each in link.all(geometry) if each.line == shape.line]
            own = [body for body in bodies if lines.get(body) == shape.line]
            if own and len(own) < len(alike):
                shape.refuse("a shape without geometry in its line: give each a line of its own")
            files = parts.get(own[alike.index(shape)], ()) if own else ()
            indent, after = stated.previousSibling, stated.nextSibling
            for each in list(_collisions(stated, files, taken)):
                if _is_blank(indent):
                    node.insertBefore(indent.cloneNode(False), after)
                node.insertBefore(each, after)
        for each in replaced:
            if _is_blank(each.previousSibling):
                node.removeChild(each.previousSibling)
            node.removeChild(each)
    written: bytes = document.toxml("utf-8")
    return written.replace(b"?>", b"?>\n", 1)


def _collisions(stated: _Node, files: Sequence[str], taken: Collection[str]) -> Iterator[_Node]:
    """Yield a collision for each file, where the link is; without files, one as is stated, but for
    its material. taken: names that none gets."""
    name, document = stated.getAttribute("name"), stated.ownerDocument
    numbers = (number for number in count(1) if f"{name}-{number}" not in taken)
    for number, file in zip(numbers, files or ("",), strict=False):
        each = document.renameNode(stated.cloneNode(True), "", "collision")
        for tag in ("material", "origin", "geometry") if file else ("material",):
            for child in _all(each, tag):
                each.removeChild(child)
        if file:
            geometry = each.appendChild(document.createElement("geometry"))
            geometry.appendChild(document.createElement("mesh")).setAttribute("filename", file)
            if name:
                each.setAttribute("name", f"{name}-{number}")
        yield each


def _all(parent: _Node, tag: str) -> list[_Node]:
    """The children with that name."""
    return [child for child in parent.childNodes if child.nodeName == tag]


def _is_blank(node: _Node | None) -> bool:
    return node is not None and node.nodeType == node.TEXT_NODE and node.data.isspace()
