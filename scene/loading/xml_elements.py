"""XML of mesh files as elements with their lines, for formats that one pass cannot read."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import IO, NoReturn

import numpy as np
from numpy.typing import NDArray

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.xml_guard import guarded_parser, parse_stream, split_name


@dataclass(slots=True, eq=False)
class Element:
    """tag and names of attributes: without their namespaces. text: all of it, in one piece."""

    tag: str
    namespace: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)
    pieces: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        return "".join(self.pieces).strip()

    def all(self, tag: str) -> list[Element]:
        return [child for child in self.children if child.tag == tag]

    def find(self, tag: str) -> Element | None:
        return next(iter(self.all(tag)), None)

    def need(self, tag: str) -> Element:
        return self.find(tag) or self.refuse(f"<{tag}> is missing")

    def attribute(self, name: str) -> str:
        if name not in self.attributes:
            self.refuse(f"attribute {name!r} is missing")
        return self.attributes[name]

    def below(self) -> Iterator[Element]:
        """All elements inside, in the order of the file."""
        waiting = list(reversed(self.children))
        while waiting:
            element = waiting.pop()
            yield element
            waiting.extend(reversed(element.children))

    def words(self, text: str, multiple: int) -> list[str]:
        """Numbers with commas or spaces between them, a multiple of `multiple` of them."""
        words = text.replace(",", " ").split()
        if len(words) % multiple:
            self.refuse(f"{len(words)} numbers, not a multiple of {multiple}")
        return words

    def floats(self, words: list[str]) -> list[float]:
        try:
            values = [float(word) for word in words]
        except ValueError as error:
            self.refuse(str(error))
        if not all(map(math.isfinite, values)):
            self.refuse("a number that is not finite", "non-finite")
        return values

    def indices(self, text: str, count: int, multiple: int = 1) -> list[int]:
        """Vertex numbers below `count`."""
        words = self.words(text, multiple)
        if not all(word.isdecimal() for word in words):
            self.refuse("a vertex number that is not a whole number")
        values = [int(word) for word in words]
        if values and max(values) >= count:
            self.refuse(f"vertex {max(values)} of {count}", "index-out-of-range")
        return values

    def floats_of_text(self) -> list[float]:
        return self.floats(self.text.split())

    def counted_floats(self) -> NDArray[np.float64]:
        """The numbers in the element, as many as its `count` says."""
        words, count = self.text.split(), self.integer("count")
        if len(words) != count:
            message = f"{self.tag} promises {count} numbers and has {len(words)}"
            self.refuse(message, "count-mismatch")
        return np.array(self.floats(words), np.float64)

    def integers(self, least: int = 0) -> list[int]:
        """The whole numbers in the element."""
        try:
            values = [int(word) for word in self.text.split()]
        except ValueError as error:
            self.refuse(str(error))
        if values and min(values) < least:
            self.refuse(f"negative number {min(values)}", "index-out-of-range")
        return values

    def integer(self, name: str) -> int:
        """An attribute that has to be there: a whole number >= 0."""
        word = self.attribute(name).strip()
        return int(word) if word.isdecimal() else self.refuse(f"{name}={word!r} is no number")

    def refuse(self, message: str, code: str = "bad-record") -> NoReturn:
        raise MeshFileError(code, f"line {self.line}: <{self.tag}>: {message}")


def read_elements(stream: IO[bytes]) -> Element:
    """The outermost element. Raises MeshFileError."""
    parser = guarded_parser()
    outside = Element("", "", {}, 0)
    around = [outside]

    def start(name: str, attributes: dict[str, str]) -> None:
        namespace, tag = split_name(name)
        plain = {split_name(key)[1]: value for key, value in attributes.items()}
        element = Element(tag, namespace, plain, parser.CurrentLineNumber)
        around[-1].children.append(element)
        around.append(element)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: around.pop()
    parser.CharacterDataHandler = lambda text: around[-1].pieces.append(text)
    parse_stream(parser, stream)
    return outside.children[0]
