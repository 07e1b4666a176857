"""XML from strangers: an expat parser that refuses entities and names the line of a defect."""

from __future__ import annotations

from collections.abc import Callable
from typing import IO, NoReturn
from xml.parsers import expat

from satcheck.scene.errors import MeshFileError

_NAMESPACE_SEPARATOR = " "
UNDECLARED = "undeclared:"
_DECLARATION = "<?xml version="  # a parser that fails within this many characters has read no XML


def guarded_parser(
    allowed_encodings: frozenset[str] | None = None, *, namespaces: bool = True
) -> expat.XMLParserType:
    """A parser whose element and attribute names read "namespace local-name".

    allowed_encodings: lower-case names the XML declaration may give; None: any that expat knows.
    namespaces: False leaves names as they are written, "prefix:local-name", declared or not.
    Raises MeshFileError from within the parse.
    """
    separator = _NAMESPACE_SEPARATOR if namespaces else None
    parser = expat.ParserCreate(namespace_separator=separator)
    parser.buffer_text = True

    def refuse_entity(*_: object) -> NoReturn:
        raise MeshFileError(
            "entity-declaration",
            f"line {parser.CurrentLineNumber}: entity declarations are refused",
        )

    def check_encoding(_version: str, encoding: str | None, _standalone: int) -> None:
        if allowed_encodings and encoding and encoding.lower() not in allowed_encodings:
            expected = " or ".join(sorted(allowed_encodings))
            raise MeshFileError(
                "bad-encoding", f"invalid XML encoding {encoding!r}: {expected} expected"
            )

    parser.EntityDeclHandler = refuse_entity
    parser.ExternalEntityRefHandler = refuse_entity
    parser.XmlDeclHandler = check_encoding
    return parser


class UnboundPrefix(MeshFileError):
    """A prefix is used and not declared."""


def parse_xml(parse: Callable[[], object]) -> None:
    """Runs a parse and turns expat's complaint into a MeshFileError."""
    try:
        parse()
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        if reason == expat.errors.XML_ERROR_UNBOUND_PREFIX:
            message = f"line {error.lineno}: not well-formed XML: {reason}"
            raise UnboundPrefix("bad-record", message) from None
        if "encoding" in reason or (error.lineno == 1 and error.offset < len(_DECLARATION)):
            message = f"invalid XML encoding, or not XML: {reason}"
            raise MeshFileError("bad-encoding", message) from None
        raise MeshFileError(
            "bad-record", f"line {error.lineno}: not well-formed XML: {reason}"
        ) from None
    except (LookupError, UnicodeError) as error:
        raise MeshFileError("bad-encoding", f"invalid XML encoding: {error}") from None


def parse_stream(parser: expat.XMLParserType, stream: IO[bytes]) -> None:
    parse_xml(lambda: parser.ParseFile(stream))


def split_name(name: str) -> tuple[str, str]:
    """(namespace, local name); the namespace is "" where there is none."""
    namespace, _, local = name.rpartition(_NAMESPACE_SEPARATOR)
    return namespace, local


class UndeclaredPrefixes:
    """The namespaces of a parser that leaves names as they are written, for XML that uses prefixes
    which it does not declare: these stand for themselves, as `UNDECLARED` and the prefix.

    start, end: called for each element, with names as those of a parser that knows namespaces.
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
        """That of a prefix here; of "" for names without one."""
        return self._scopes[-1].get(prefix)

    def _resolved(self, name: str, default: str) -> str:
        prefix, colon, local = name.partition(":")
        if not colon:
            return f"{default}{_NAMESPACE_SEPARATOR}{name}" if default else name
        namespace = self._scopes[-1].get(prefix, f"{UNDECLARED}{prefix}")
        return f"{namespace}{_NAMESPACE_SEPARATOR}{local}"
