"""Writes a URDF whose collision geometry is convex parts. All other bytes stay as they are, but for
relative names of files, if it goes to another folder."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from xml.sax.saxutils import quoteattr

from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.files.xml_tree import guarded_parser, parse_xml
from satcheck.scene.robot.assembly import SceneRobot
from satcheck.scene.robot.reading import well_formed

# Of an element: its start tag, in which > may stand in a value.
_START_TAG = re.compile(rb"""<(?:[^"'>]|"[^"]*"|'[^']*')*>""")
_NAME = re.compile(rb"""(\sname\s*=\s*)(["'])(.*?)\2""", re.DOTALL)
_FILE = re.compile(rb"""(\sfilename\s*=\s*["'])(?![\\/]|\w+:)""")
_INDENT = re.compile(rb"\n[ \t]*\Z")
_NAME_FILES = ("mesh", "texture")


@dataclass(slots=True, eq=False)
class _Element:
    """An element, and its bytes in the document: start, the end of its start tag, end."""

    tag: str
    name: str
    line: int
    start: int
    opened: int
    end: int = 0
    children: list[_Element] = field(default_factory=list)

    def all(self, *tags: str) -> list[_Element]:
        return [child for child in self.children if child.tag in tags]

    def below(self) -> Iterator[_Element]:
        for child in self.children:
            yield child
            yield from child.below()


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
    data = well_formed(data)
    root = _elements(data)
    if root.tag != "robot":
        message = f"<{root.tag}> is no URDF: parts as .urdf are made from one URDF"
        raise Refused("unsupported-feature", message, file=robot.robot.file)
    edits: list[tuple[int, int, bytes]] = []
    for link in root.all("link"):
        bodies = [body.id for body in robot.bodies if body.link == link.name]
        for shape in link.all(geometry):
            alike = [each for each in link.all(geometry) if each.line == shape.line]
            own = [body for body in bodies if lines.get(body) == shape.line]
            if own and len(own) < len(alike):
                message = "shapes without geometry beside others: give each a line of its own"
                raise Refused("bad-robot", f"line {shape.line}: {message}", file=robot.robot.file)
            files = parts.get(own[alike.index(shape)], ()) if own else ()
            if files:
                edits.append((shape.start, shape.end, _collisions(data, shape, files)))
    if geometry == "visual":
        edits = list(_as_collisions(data, root, edits))
    if back:
        edits += _moved(data, root, edits, back)
    return _edited(data, 0, len(data), edits)


def _elements(data: bytes) -> _Element:
    """The outermost element."""
    parser = guarded_parser(namespaces=False)
    outermost: list[_Element] = []
    around: list[_Element] = []

    def start(tag: str, attributes: dict[str, str]) -> None:
        first = parser.CurrentByteIndex
        opened = _START_TAG.match(data, first)
        if opened is None:
            raise Refused("bad-encoding", "a URDF that is rewritten has to be ASCII or UTF-8")
        name, line = attributes.get("name", ""), parser.CurrentLineNumber
        element = _Element(tag, name, line, first, opened.end())
        (around[-1].children if around else outermost).append(element)
        around.append(element)

    def end(_: str) -> None:
        element = around.pop()
        empty = data[: element.opened].endswith(b"/>")
        closed = element.opened if empty else data.index(b">", parser.CurrentByteIndex) + 1
        element.end = closed

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parse_xml(parser, data)
    return outermost[0]


def _collisions(data: bytes, shape: _Element, files: Sequence[str]) -> bytes:
    """A copy of the element for each file: without its origin, and the file its geometry."""
    copies = []
    for number, file in enumerate(files, 1):
        named = quoteattr(file).encode("ascii", "xmlcharrefreplace")
        mesh = b"<geometry><mesh filename=" + named + b"/></geometry>"
        edits = [(each.start, each.end, b"") for each in shape.all("origin")]
        edits += [(each.start, each.end, mesh) for each in shape.all("geometry")[:1]]
        opened = data[shape.start : shape.opened]
        numbered = _NAME.sub(rb"\g<1>\g<2>\g<3>-%d\g<2>" % number, opened, count=1)
        copies.append(numbered + _edited(data, shape.opened, shape.end, edits))
    indent = _INDENT.search(data, 0, shape.start)
    return (indent[0] if indent else b"\n").join(copies)


def _as_collisions(
    data: bytes, root: _Element, edits: Sequence[tuple[int, int, bytes]]
) -> Iterator[tuple[int, int, bytes]]:
    """Edits that leave the visuals, and put the collisions made from them behind each."""
    made = {first: text for first, _, text in edits}
    for link in root.all("link"):
        for each in link.all("collision"):
            yield each.start, each.end, b""
        for each in link.all("visual"):
            text = made.get(each.start, data[each.start : each.end])
            text = re.sub(rb"(</?)visual\b", rb"\1collision", text)
            indent = _INDENT.search(data, 0, each.start)
            yield each.end, each.end, (indent[0] if indent else b"\n") + text


def _moved(
    data: bytes, root: _Element, edits: Sequence[tuple[int, int, bytes]], back: str
) -> Iterator[tuple[int, int, bytes]]:
    """Edits of relative names of files, outside of other edits."""
    prefix = f"{quoteattr(back)[1:-1]}/".encode("ascii", "xmlcharrefreplace")
    for each in root.below():
        named = _FILE.search(data, each.start, each.opened) if each.tag in _NAME_FILES else None
        if named and not any(first <= each.start < last for first, last, _ in edits):
            yield named.end(), named.end(), prefix


def _edited(data: bytes, first: int, last: int, edits: Sequence[tuple[int, int, bytes]]) -> bytes:
    """The bytes from first to last, in which the text of each edit replaces its range."""
    pieces = []
    for start, end, text in sorted(edits):
        pieces += [data[first:start], text]
        first = end
    return b"".join([*pieces, data[first:last]])
