"""Parses XML of untrusted files into elements with line numbers. Entities are refused."""

from __future__ import annotations

import math
import re
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NoReturn
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from satcheck.scene.errors import Refused
from satcheck.scene.files.limits import MAX_DEPTH

_NAMESPACE_SEPARATOR = " "
UNDECLARED = "undeclared:"
_DECLARATION = "<?xml version="  # if a parser fails within these characters, the file is not XML
# Decimal numbers as in C. float() would accept more ("1_0", "nan", digits of any script).
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?", re.ASCII)
_PREFIX = re.compile(r"[<\s]([^\W\d][\w.-]*):[^\W\d]")  # of an element or an attribute
# The name of the outermost element with all before it, and its attributes.
_OUTERMOST = re.compile(r"((?:<\?.*?\?>|<!--.*?-->|<![^>]*>|[^<]++)*+<[^\s/>]+)([^>]*)", re.DOTALL)
_MOST_DIGITS = 18  # of a count or an index
_XACRO = re.compile(r"\$[({]")
EXPAND = "this is xacro, a macro language: expand it first (xacro FILE.xacro > FILE)"


def guarded_parser(
    allowed_encodings: frozenset[str] | None = None, *, namespaces: bool = True
) -> expat.XMLParserType:
    """A parser that reports names of elements and attributes as "namespace local-name".

    allowed_encodings: lower-case names of encodings that are accepted; None: all that expat knows.
    namespaces: False reports names as written, "prefix:local-name", even if the prefix is not
    declared. Parsing raises Refused.
    """
    separator = _NAMESPACE_SEPARATOR if namespaces else None
    parser = expat.ParserCreate(namespace_separator=separator)
    parser.buffer_text = True

    def refuse_entity(*_: object) -> NoReturn:
        raise Refused(
            "entity-declaration",
            f"line {parser.CurrentLineNumber}: entity declarations are refused",
        )

    def check_encoding(_version: str, encoding: str | None, _standalone: int) -> None:
        if allowed_encodings and encoding and encoding.lower() not in allowed_encodings:
            expected = " or ".join(sorted(allowed_encodings))
            raise Refused("bad-encoding", f"invalid XML encoding {encoding!r}: {expected} expected")

    parser.EntityDeclHandler = refuse_entity
    parser.ExternalEntityRefHandler = refuse_entity
    parser.XmlDeclHandler = check_encoding
    return parser


class UnboundPrefix(Refused):
    """A prefix is used but not declared."""


def parse_xml(parser: expat.XMLParserType, data: bytes | memoryview, *, whole: bool = True) -> None:
    """Parse a document, or the head of one. Raises Refused instead of errors of expat."""
    try:
        parser.Parse(data, whole)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        if reason == expat.errors.XML_ERROR_UNBOUND_PREFIX:
            message = f"line {error.lineno}: not well-formed XML: {reason}"
            raise UnboundPrefix("bad-record", message) from None
        if "encoding" in reason or (error.lineno == 1 and error.offset < len(_DECLARATION)):
            message = f"invalid XML encoding, or not XML: {reason}"
            raise Refused("bad-encoding", message) from None
        raise Refused("bad-record", f"line {error.lineno}: not well-formed XML: {reason}") from None
    except (LookupError, UnicodeError) as error:
        raise Refused("bad-encoding", f"invalid XML encoding: {error}") from None


def split_name(name: str) -> tuple[str, str]:
    """(namespace, local name); the namespace is "" if there is none."""
    namespace, _, local = name.rpartition(_NAMESPACE_SEPARATOR)
    return namespace, local


def local_name(name: str) -> str:
    return split_name(name)[1]


def with_declared_prefixes(data: bytes) -> bytes:
    """The document, whose outermost element declares all prefixes: the namespace of one without a
    declaration is `UNDECLARED` and the prefix."""
    is_wide = data.startswith((BOM_UTF16_LE, BOM_UTF16_BE))
    coding = ("utf-16", "replace") if is_wide else ("utf-8", "surrogateescape")
    text = data.decode(*coding)
    outermost = _OUTERMOST.match(text)
    if outermost is None:
        return data
    known = {"xml", "xmlns", *re.findall(r"\bxmlns:([\w.-]+)", outermost[2])}
    used = dict.fromkeys(prefix for prefix in _PREFIX.findall(text) if prefix not in known)
    more = "".join(f' xmlns:{prefix}="{UNDECLARED}{prefix}"' for prefix in used)
    return f"{outermost[1]}{more}{text[outermost.end(1) :]}".encode(*coding)


class RefusedElement(Refused):
    """An element of a robot. at: its line; reason: what is wrong with it."""

    def __init__(self, code: str, at: int, reason: str, file: str) -> None:
        super().__init__(code, f"line {at}: {reason}", file=file)
        self.at = at
        self.reason = reason


@dataclass(slots=True, eq=False)
class Element:
    """tag and names of attributes: without namespaces, or as written in a robot. file: the path of
    a robot as given, which errors then name; "": of a mesh file. text: of the whole element."""

    tag: str
    attributes: dict[str, str]
    line: int
    file: str = ""
    children: list[Element] = field(default_factory=list)
    pieces: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        return "".join(self.pieces).strip()

    def all(self, tag: str) -> list[Element]:
        return [child for child in self.children if child.tag == tag]

    def find(self, tag: str) -> Element | None:
        return next(iter(self.all(tag)), None)

    def only(self, tag: str) -> Element | None:
        """The child with that name, or None. Several are refused unless they are equal."""
        matches = self.all(tag)
        for other in matches[1:]:
            if not other.says_the_same_as(matches[0]):
                other.refuse(f"a second <{tag}> in one <{self.tag}>")
        return matches[0] if matches else None

    def need(self, tag: str) -> Element:
        return self.only(tag) or self.refuse(f"<{tag}> is missing")

    def says_the_same_as(self, other: Element) -> bool:
        return (
            (self.tag, self.text, self.attributes) == (other.tag, other.text, other.attributes)
            and len(self.children) == len(other.children)
            and all(map(Element.says_the_same_as, self.children, other.children))
        )

    def attribute(self, name: str) -> str:
        """A required attribute that is not empty."""
        return self.attributes.get(name) or self.refuse(f'attribute "{name}" is missing')

    def below(self) -> Iterator[Element]:
        """All elements inside, in the order of the file."""
        waiting = list(reversed(self.children))
        while waiting:
            element = waiting.pop()
            yield element
            waiting.extend(reversed(element.children))

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

    def counted_floats(self) -> NDArray[np.float64]:
        """The numbers in the element. Their count has to equal its `count`."""
        words, count = self.text.split(), self.integer("count")
        if len(words) != count:
            message = f"{self.tag} promises {count} numbers and has {len(words)}"
            self.refuse(message, "count-mismatch")
        try:
            values = np.array(list(map(float, words)), np.float64)
        except ValueError as error:
            self.refuse(str(error))
        if not np.isfinite(values).all():
            self.refuse("a number that is not finite", "non-finite")
        return values

    def integers(self) -> list[int]:
        """The whole numbers >= 0 in the element."""
        try:
            values = [int(word) for word in self.text.split()]
        except ValueError as error:  # no whole number, or one of thousands of digits
            self.refuse(str(error))
        if values and min(values) < 0:
            self.refuse(f"negative number {min(values)}", "index-out-of-range")
        return values

    def integer(self, name: str) -> int:
        """A required attribute: a whole number >= 0."""
        word = self.attribute(name).strip()
        if not (word.isdecimal() and len(word) <= _MOST_DIGITS):
            self.refuse(f"{name}={word!r} is not a number")
        return int(word)

    def refuse(self, message: str, code: str | None = None) -> NoReturn:
        """Raises Refused (`bad-record`), or RefusedElement (`bad-robot`) in a robot."""
        reason = f"<{self.tag}>: {message}"
        if self.file:
            raise RefusedElement(code or "bad-robot", self.line, reason, self.file)
        raise Refused(code or "bad-record", f"line {self.line}: {reason}")


def read_elements(
    data: bytes | memoryview,
    *,
    encodings: frozenset[str] | None = None,
    file: str | None = None,
    tag_of: Callable[[str], str] = local_name,
    key_of: Callable[[str], str] = local_name,
    prefixes: dict[str | None, str] | None = None,
) -> Element:
    """The outermost element. Raises Refused.

    encodings: as in `guarded_parser`. file: of a robot, whose names keep their prefixes. tag_of,
    key_of: the names of elements and attributes by those of the parser. prefixes: takes the
    namespaces of all prefixes.
    """
    parser = guarded_parser(encodings, namespaces=file is None)
    outermost: list[Element] = []
    around: list[Element] = []

    def start(name: str, attributes: dict[str, str]) -> None:
        named = {key_of(key): value for key, value in attributes.items()}
        element = Element(tag_of(name), named, parser.CurrentLineNumber, file or "")
        if len(around) >= MAX_DEPTH:
            message = (
                f"line {element.line}: elements are nested deeper than {MAX_DEPTH}: flatten it"
            )
            raise Refused("too-large", message)
        (around[-1].children if around else outermost).append(element)
        around.append(element)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: around.pop()
    parser.CharacterDataHandler = lambda text: around[-1].pieces.append(text) if around else None
    if prefixes is not None:
        parser.StartNamespaceDeclHandler = prefixes.__setitem__
    try:
        parse_xml(parser, data)
    except Refused as error:
        if not around:
            raise
        still = f"<{around[-1].tag}> of line {around[-1].line} was still open"
        raise type(error)(error.code, f"{error.message}; {still}") from None
    return outermost[0]
