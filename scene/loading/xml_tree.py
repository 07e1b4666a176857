"""Parses XML of untrusted files. Entities are refused, and elements keep their line numbers."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import IO, NoReturn, Self, TypeVar
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from satcheck.scene.errors import Refused
from satcheck.scene.loading.limits import MAX_DEPTH

_NAMESPACE_SEPARATOR = " "
UNDECLARED = "undeclared:"
_DECLARATION = "<?xml version="  # if a parser fails within these characters, the file is not XML


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


def parse_xml(parse: Callable[[], object]) -> None:
    """Runs a parser and turns an error of expat into a Refused."""
    try:
        parse()
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


def parse_stream(parser: expat.XMLParserType, stream: IO[bytes]) -> None:
    parse_xml(lambda: parser.ParseFile(stream))


def split_name(name: str) -> tuple[str, str]:
    """(namespace, local name); the namespace is "" if there is none."""
    namespace, _, local = name.rpartition(_NAMESPACE_SEPARATOR)
    return namespace, local


class UndeclaredPrefixes:
    """Resolves namespaces for XML that uses undeclared prefixes. The namespace of such a prefix is
    `UNDECLARED` and the prefix.

    start, end: called for each element, with names as a parser with namespaces reports them.
    """

    def __init__(
        self,
        parser: expat.XMLParserType,
        start: Callable[[str, dict[str, str]], None],
        end: Callable[[str], None],
    ) -> None:
        self._start = start
        self._end = end
        self._scopes: list[dict[str, str]] = [{"xml": "xml"}]
        parser.StartElementHandler = self._on_start
        parser.EndElementHandler = self._on_end

    def _on_start(self, name: str, attributes: dict[str, str]) -> None:
        declared = {
            key.partition(":")[2]: attributes.pop(key)
            for key in list(attributes)
            if key == "xmlns" or key.startswith("xmlns:")
        }
        self._scopes.append({**self._scopes[-1], **declared} if declared else self._scopes[-1])
        self._start(
            self._resolved(name, self.namespace("") or ""),
            {self._resolved(key, ""): value for key, value in attributes.items()},
        )

    def _on_end(self, name: str) -> None:
        self._end(self._resolved(name, self.namespace("") or ""))
        self._scopes.pop()

    def namespace(self, prefix: str) -> str | None:
        """The namespace of a prefix at this point; prefix "" for names without one."""
        return self._scopes[-1].get(prefix)

    def _resolved(self, name: str, default: str) -> str:
        prefix, colon, local = name.partition(":")
        if not colon:
            return f"{default}{_NAMESPACE_SEPARATOR}{name}" if default else name
        namespace = self._scopes[-1].get(prefix, f"{UNDECLARED}{prefix}")
        return f"{namespace}{_NAMESPACE_SEPARATOR}{local}"


@dataclass(slots=True, eq=False)
class Element:
    """tag and names of attributes: without namespaces. text: the whole text of the element."""

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Self] = field(default_factory=list)
    pieces: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        return "".join(self.pieces).strip()

    def all(self, tag: str) -> list[Self]:
        return [child for child in self.children if child.tag == tag]

    def find(self, tag: str) -> Self | None:
        return next(iter(self.all(tag)), None)

    def need(self, tag: str) -> Self:
        return self.find(tag) or self.refuse(f"<{tag}> is missing")

    def attribute(self, name: str) -> str:
        if name not in self.attributes:
            self.refuse(f"attribute {name!r} is missing")
        return self.attributes[name]

    def below(self) -> Iterator[Self]:
        """All elements inside, in the order of the file."""
        waiting = list(reversed(self.children))
        while waiting:
            element = waiting.pop()
            yield element
            waiting.extend(reversed(element.children))

    def floats(self, words: list[str]) -> list[float]:
        try:
            values = [float(word) for word in words]
        except ValueError as error:
            self.refuse(str(error))
        if not all(map(math.isfinite, values)):
            self.refuse("a number that is not finite", "non-finite")
        return values

    def counted_floats(self) -> NDArray[np.float64]:
        """The numbers in the element. Their count has to equal its `count`."""
        words, count = self.text.split(), self.integer("count")
        if len(words) != count:
            message = f"{self.tag} promises {count} numbers and has {len(words)}"
            self.refuse(message, "count-mismatch")
        return np.array(self.floats(words), np.float64)

    def integers(self) -> list[int]:
        """The whole numbers >= 0 in the element."""
        values = self._whole(self.text.split())
        if values and min(values) < 0:
            self.refuse(f"negative number {min(values)}", "index-out-of-range")
        return values

    def integer(self, name: str) -> int:
        """A required attribute: a whole number >= 0."""
        word = self.attribute(name).strip()
        if not word.isdecimal():
            self.refuse(f"{name}={word!r} is not a number")
        return self._whole([word])[0]

    def _whole(self, words: list[str]) -> list[int]:
        try:
            return [int(word) for word in words]
        except ValueError as error:  # no whole number, or one of thousands of digits
            self.refuse(str(error))

    def refuse(self, message: str, code: str = "bad-record") -> NoReturn:
        raise Refused(code, f"line {self.line}: <{self.tag}>: {message}")


E = TypeVar("E", bound=Element)


def read_elements(
    data: bytes | memoryview | IO[bytes],
    *,
    encodings: frozenset[str] | None = None,
) -> Element:
    """The outermost element. encodings: as in `guarded_parser`. Raises Refused."""
    stream = io.BytesIO(data) if isinstance(data, bytes | memoryview) else data
    return parse_elements(guarded_parser(encodings), stream, Element)


def parse_elements(
    parser: expat.XMLParserType,
    stream: IO[bytes],
    make: Callable[[str, dict[str, str], int], E],
) -> E:
    """The outermost element. make: creates an element from tag, attributes and line."""
    outermost: list[E] = []
    around: list[E] = []

    def start(name: str, attributes: dict[str, str]) -> None:
        plain = {split_name(key)[1]: value for key, value in attributes.items()}
        element = make(split_name(name)[1], plain, parser.CurrentLineNumber)
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
    try:
        parse_stream(parser, stream)
    except Refused as error:
        if not around:
            raise
        still = f"<{around[-1].tag}> of line {around[-1].line} was still open"
        raise Refused(error.code, f"{error.message}; {still}") from None
    return outermost[0]
