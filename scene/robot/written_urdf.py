"""Writes a URDF whose collision geometry is convex parts. All other bytes stay as they are, but for
relative names of files, if it goes to another folder."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import count
from xml.sax.saxutils import quoteattr

from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.assembly import SceneRobot
from satcheck.scene.robot.reading import parsed

# Of an element: its start tag, in which > may stand in a value.
_START_TAG = re.compile(rb"""<(?:[^"'>]|"[^"]*"|'[^']*')*>""")
_NAME = re.compile(rb"""(\sname\s*=\s*)(["'])(.*?)\2""", re.DOTALL)
_FILE = re.compile(rb"""(\sfilename\s*=\s*["'])(?![\\/]|\w+:)""")
_INDENT = re.compile(rb"\n[ \t]*\Z")
_VISUAL = re.compile(rb"(</?)visual\b")
_NAME_FILES = ("mesh", "texture")
_Edit = tuple[int, int, bytes]  # the first byte, the one after the last, what replaces them


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
    if b"\0" in data:  # UTF-16
        root.refuse("a URDF that is rewritten has to be in ASCII or UTF-8", "bad-encoding")
    edits: list[_Edit] = []
    prefix = f"{quoteattr(back)[1:-1]}/".encode("ascii", "xmlcharrefreplace") if back else b""
    for link in root.all("link"):
        bodies = robot.bodies_of(link.attribute("name"))
        if geometry == "visual":
            edits += [(each.start, _end(data, each), b"") for each in link.all("collision")]
        for shape in link.all(geometry):
            alike = [each for each in link.all(geometry) if each.line == shape.line]
            own = [body for body in bodies if lines.get(body) == shape.line]
            if own and len(own) < len(alike):
                shape.refuse("a shape without geometry in its line: give each a line of its own")
            end, indent = _end(data, shape), _INDENT.search(data, 0, shape.start)
            between = indent[0] if indent else b"\n"
            files = parts.get(own[alike.index(shape)], ()) if own else ()
            taken = {each.attributes.get("name") for each in link.all("collision")}
            text = between.join(_collisions(data, shape, files, taken))
            if geometry == "visual":
                bare = _edited(data, shape.start, end, _without(data, shape, "material"))
                text = text or _FILE.sub(rb"\g<1>" + prefix, bare)
                edits.append((end, end, between + _VISUAL.sub(rb"\1collision", text)))
            elif files:
                edits.append((shape.start, end, text))
    for each in root.below() if back else ():
        kept = not any(first <= each.start < last for first, last, _ in edits)
        named = (
            kept and each.tag in _NAME_FILES and _FILE.search(data, each.start, _opened(data, each))
        )
        if named:
            edits.append((named.end(), named.end(), prefix))
    return _edited(data, 0, len(data), edits)


def _opened(data: bytes, element: Element) -> int:
    """The end of its start tag."""
    return next(_START_TAG.finditer(data, element.start)).end()


def _end(data: bytes, element: Element) -> int:
    opened = _opened(data, element)
    return opened if data.endswith(b"/>", 0, opened) else data.index(b">", element.last) + 1


def _without(data: bytes, shape: Element, tag: str) -> list[_Edit]:
    return [(each.start, _end(data, each), b"") for each in shape.all(tag)]


def _collisions(
    data: bytes, shape: Element, files: Sequence[str], taken: Collection[str | None]
) -> Iterator[bytes]:
    """Yield a copy of the element for each file: without its origin, the file its geometry. taken:
    names that no copy gets."""
    opened, last = _opened(data, shape), _end(data, shape)
    name = shape.attributes.get("name")
    numbers = (number for number in count(1) if f"{name}-{number}" not in taken)
    for number, file in zip(numbers, files, strict=False):
        named = quoteattr(file).encode("ascii", "xmlcharrefreplace")
        mesh = b"<geometry><mesh filename=" + named + b"/></geometry>"
        edits = [*_without(data, shape, "origin"), *_without(data, shape, "material")]
        edits += [(each.start, _end(data, each), mesh) for each in shape.all("geometry")[:1]]
        tag = data[shape.start : opened]
        numbered = _NAME.sub(rb"\g<1>\g<2>\g<3>-%d\g<2>" % number, tag, count=1)
        yield numbered + _edited(data, opened, last, edits)


def _edited(data: bytes, first: int, last: int, edits: Sequence[_Edit]) -> bytes:
    """The bytes from first to last, in which the text of each edit replaces its range."""
    pieces = []
    for start, end, text in sorted(edits):
        pieces += [data[first:start], text]
        first = end
    return b"".join([*pieces, data[first:last]])
