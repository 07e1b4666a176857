"""Reads small XML documents strictly, into elements with line numbers."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NoReturn, Self

from satcheck.scene.errors import Refused
from satcheck.scene.loading import xml_tree
from satcheck.scene.loading.xml_tree import guarded_parser, parse_elements, parse_xml
from satcheck.scene.opening import read_whole

_MAX_BYTES = 64 << 20
# Decimal numbers as in C. float() would accept more ("1_0", "nan", digits of any script).
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?", re.ASCII)
_XACRO = re.compile(r"\$[({]")
EXPAND = "this is xacro, a macro language: expand it first (xacro FILE.xacro > FILE.urdf)"
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


class RefusedElement(Refused):
    """at: the line of the element; reason: what is wrong with it."""

    def __init__(self, code: str, at: int, reason: str, file: str) -> None:
        super().__init__(code, f"line {at}: {reason}", file=file)
        self.at = at
        self.reason = reason


@dataclass(slots=True, eq=False)
class Element(xml_tree.Element):
    """file: the document's path as given. Names keep their prefixes."""

    file: str = ""

    def only(self, tag: str) -> Self | None:
        """The child with that name, or None. Several are refused unless they are equal."""
        matches = self.all(tag)
        for other in matches[1:]:
            if not other.says_the_same_as(matches[0]):
                other.refuse(f"a second <{tag}> in one <{self.tag}>")
        return matches[0] if matches else None

    def says_the_same_as(self, other: Self) -> bool:
        return (
            self.tag == other.tag
            and self.text == other.text
            and self.attributes == other.attributes
            and len(self.children) == len(other.children)
            and all(
                mine.says_the_same_as(its)
                for mine, its in zip(self.children, other.children, strict=True)
            )
        )

    def need(self, tag: str) -> Self:
        return self.only(tag) or self.refuse(f"<{tag}> is missing")

    def attribute(self, name: str) -> str:
        """A required attribute that is not empty."""
        return self.attributes.get(name) or self.refuse(f'attribute "{name}" is missing')

    def numbers(
        self, attribute: str, count: int, default: tuple[float, ...] | None = None
    ) -> tuple[float, ...]:
        """`count` finite numbers. Without a default the attribute is required."""
        if default is not None and attribute not in self.attributes:
            return default
        return self._numbers(f"{attribute}=", self.attribute(attribute), count)

    def number(self, attribute: str, default: float | None = None) -> float:
        return self.numbers(attribute, 1, None if default is None else (default,))[0]

    def text_numbers(self, count: int) -> tuple[float, ...]:
        """`count` finite numbers, which are the text of the element."""
        return self._numbers("", self.text, count)

    def refuse(self, message: str, code: str = "bad-robot") -> NoReturn:
        raise RefusedElement(code, self.line, f"<{self.tag}>: {message}", self.file)

    def _numbers(self, before: str, value: str, count: int) -> tuple[float, ...]:
        """before: what stands in front of the value in messages."""
        words = value.split()
        if len(words) != count:
            wanted = "1 number" if count == 1 else f"{count} numbers"
            self._refuse_value(before, value, f"should be {wanted}")
        return tuple(self._number(before, word) for word in words)

    def _number(self, before: str, word: str) -> float:
        value = float(word) if _NUMBER.fullmatch(word) else math.nan
        if not math.isfinite(value):
            self._refuse_value(before, word, "is not a finite number")
        return value

    def _refuse_value(self, before: str, value: str, what: str) -> NoReturn:
        if _XACRO.search(value):
            self.refuse(f'{before}"{value}": {EXPAND}', "xacro")
        self.refuse(f'{before}"{value}" {what}')


def read_tree(path: str, location: Path, *roots: str) -> Element:
    """Return the outermost element, whose tag has to be one of `roots`, if there are any.

    Text between elements is ignored. Raises Refused, with the line.
    """
    document = _parse(path, read_whole(path, location, _MAX_BYTES))
    if roots and document.tag not in roots:
        refuse_root(document, roots)
    _refuse_macros(document)
    return document


def refuse_root(document: Element, wanted: Iterable[str]) -> NoReturn:
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
    parser.StartElementHandler = lambda tag, _: tags.append(tag)
    with suppress(Refused):  # the reader reports the error
        parse_xml(lambda: parser.Parse(_with_declaration_first(head), False))
    return tags[:count]


def _with_declaration_first(data: bytes) -> bytes:
    """Moves white space in front of <?xml ...?>, a common mistake, behind it. All lines except the
    first keep their numbers."""
    return _DECLARATION.sub(rb"\2\1", data)


def _parse(path: str, data: bytes) -> Element:
    try:
        with suppress(Refused):
            return _parsed(path, data)
        return _parsed(path, _AMPERSAND.sub(b"&amp;", _without_comments(data)))
    except Refused as error:
        if _ERB in data:
            raise Refused("xacro", f"{error.message}: {_EXPAND_ERB}", file=path) from None
        raise Refused(error.code, error.message, file=path) from None


def _parsed(path: str, data: bytes) -> Element:
    stream = io.BytesIO(_with_declaration_first(data))
    return parse_elements(guarded_parser(namespaces=False), stream, partial(Element, file=path))


def _without_comments(data: bytes) -> bytes:
    """The document with blanks for comments. Programs for robots accept comments that XML does not
    allow: with -- in them, or before <?xml ...?>; and an & that is no &amp;. All lines keep their
    numbers."""
    return _COMMENT.sub(lambda comment: _NO_LINE_END.sub(b" ", comment[0]), data)
