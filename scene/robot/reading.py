"""Reads a robot: the outermost element of its XML says with which reader.

Macros are refused, because they may expand to geometry. Slips that programs for robots accept are
mended: white space before <?xml ...?>, odd comments, and an & that begins no reference.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import NoReturn

from satcheck.scene.access import Permitted
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import Reader, reader_of_robot, robot_reader, robots
from satcheck.scene.files.xml_tree import (
    EXPAND,
    Element,
    guarded_parser,
    parse_xml,
    read_elements,
)
from satcheck.scene.opening import read_whole

_ERB = b"<%"
_EXPAND_ERB = "this is ERB, a macro language: expand it first (erb FILE.erb > FILE)"
_XACRO_NAMESPACE = "xacro"  # at the end of its URI; its prefix may differ
# Harmless xacro: definitions, and macros inside elements that place no geometry.
_DEFINES = frozenset(("property", "arg", "macro"))
_PLACES_NOTHING = frozenset(("visual", "inertial", "gazebo", "transmission", "material"))
_COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
_NO_LINE_END = re.compile(rb"[^\r\n]")
# An ampersand that begins no reference.
_AMPERSAND = re.compile(rb"&(?!(?:[A-Za-z_:][\w:.-]*|#[0-9]+|#x[0-9A-Fa-f]+);)")
_DECLARATION = re.compile(rb"\A(\s+)(<\?xml\s.*?\?>)", re.DOTALL)


def required_robot_reader(path: str, permitted: Permitted) -> Reader:
    """Return the reader of a robot, which its outermost element decides. Raises Refused if there is
    none."""
    reader = reader_of_robot(path)
    if reader is not None:
        return reader
    root = read_tree(path, permitted)  # a slip may stand before the element
    return robot_reader(root.tag) or _refuse_root(root, robots())


def read_tree(path: str, permitted: Permitted, *roots: str) -> Element:
    """Return the outermost element, whose tag has to be one of `roots`, if there are any.

    Text between elements is ignored. Raises Refused, with the line.
    """
    document, _ = parsed(path, read_whole(path, permitted.most_of_tree))
    if roots and document.tag not in roots:
        _refuse_root(document, roots)
    _refuse_macros(document)
    return document


def _refuse_root(document: Element, wanted: Iterable[str]) -> NoReturn:
    """Raise an error that names the tags of outermost elements that are read."""
    said = " or ".join(f"<{root}>" for root in wanted)
    document.refuse(f"the outermost element should be {said}", "not-this-format")


def _refuse_macros(document: Element) -> None:
    """Refuses macros that may expand to geometry. The file must be expanded first."""
    prefixes = tuple(
        f"{name.removeprefix('xmlns:')}:"
        for name, uri in document.attributes.items()
        if name.startswith("xmlns:") and uri.endswith(_XACRO_NAMESPACE)
    )
    matches = list(_macros(document, (*prefixes, "xacro:")))
    if matches:
        more = f"; {len(matches) - 1} more elements are macros" if len(matches) > 1 else ""
        matches[0].refuse(f"{EXPAND}{more}", "xacro")


def _macros(element: Element, prefixes: tuple[str, ...]) -> Iterator[Element]:
    for child in element.children:
        prefix, _, name = child.tag.rpartition(":")
        if f"{prefix}:" in prefixes:
            if name not in _DEFINES:
                yield child
        elif child.tag not in _PLACES_NOTHING:
            yield from _macros(child, prefixes)


def first_tags(head: bytes, count: int) -> list[str]:
    """The names of the first elements of a document, which may be truncated; fewer if it ends early
    or is not XML."""
    parser = guarded_parser(namespaces=False)
    tags: list[str] = []

    def add(tag: str, _: object) -> None:
        tags.append(tag)
        if len(tags) == count:
            parser.StartElementHandler = None

    parser.StartElementHandler = add
    with suppress(Refused):  # the reader reports the error
        parse_xml(parser, _with_declaration_first(head), whole=False)
    return tags


def _with_declaration_first(data: bytes) -> bytes:
    """Moves white space in front of <?xml ...?>, a common mistake, behind it. All lines except the
    first keep their numbers."""
    return _DECLARATION.sub(rb"\2\1", data)


def parsed(path: str, data: bytes) -> tuple[Element, bytes]:
    """Return the outermost element of a robot, and the document that it was parsed from: the data,
    with slips mended. Raises Refused."""
    try:
        document = _with_declaration_first(data)
        with suppress(Refused):
            return read_elements(document, file=path), document
        document = _with_declaration_first(_mended(data))
        return read_elements(document, file=path), document
    except Refused as error:
        if _ERB in data:
            raise Refused("xacro", f"{error.message}: {_EXPAND_ERB}", file=path) from None
        raise Refused(error.code, error.message, file=path) from None


def _mended(data: bytes) -> bytes:
    """The document with blanks for comments, and &amp; for an & that begins no reference. Programs
    for robots accept comments that XML does not allow: with -- in them, or before <?xml ...?>. All
    lines keep their numbers."""
    plain = _COMMENT.sub(lambda comment: _NO_LINE_END.sub(b" ", comment[0]), data)
    return _AMPERSAND.sub(b"&amp;", plain)
