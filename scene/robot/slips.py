"""Mistakes of a robot file that refuse nothing, and names that nobody reads."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Iterable, Mapping

from msgspec import Struct

from satcheck.core.errors import SatcheckError
from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.files.xml_tree import Element, RefusedElement
from satcheck.scene.issue import Issue, issue
from satcheck.scene.vocabulary import Names, reasons


class Place(Struct, frozen=True):
    """The names that may stand in an element.

    elements: None: the reader refuses the body of a child that it does not know. idle: names that
    place nothing if each of their numbers, or words, is this one. inside: the places of children
    that are looked into as well. moves: no body is lost with a misspelt child, so it only blocks a
    pass. text: the reader reads the text of the element; numbers in any other are a lost value.
    """

    elements: Names | None = Names(frozenset())
    attributes: Names = Names(frozenset())
    idle: Mapping[str, float | str] = {}
    inside: Mapping[str, Place] = {}
    moves: bool = False
    text: bool = False


_ELEMENTS_ANYWHERE = reasons(a_definition="xacro:property xacro:arg xacro:macro")
_ATTRIBUTES_ANYWHERE = reasons(says_how_names_are_written="xmlns xmlns:* xml:* xsi:*")
_IN_NUMBERS = "0123456789+-.,eE \t\r\n"


def elements(read: str, *harmless: dict[str, str], **more: str) -> Names:
    """Return the names of children. read: separated by blanks. more: as of `reasons`."""
    known = ChainMap(reasons(**more), _ELEMENTS_ANYWHERE, *harmless)
    return Names(frozenset(read.split()), dict(known))


def attributes(read: str, **harmless: str) -> Names:
    return Names(frozenset(read.split()), _ATTRIBUTES_ANYWHERE | reasons(**harmless))


class Slips:
    """Collects mistakes in file order, with one warning for each cause. geometry: what is checked;
    others: the other kind, which is harmless."""

    def __init__(self, geometry: GeometryKind = "collision") -> None:
        self.geometry = geometry
        self.others = "visual" if geometry == "collision" else "collision"
        self._lines: dict[tuple[str, str, str], list[int]] = {}

    def note(self, code: str, element: Element, cause: str) -> None:
        self._lines.setdefault((code, cause, element.file), []).append(element.line)

    def look(self, element: Element, place: Place) -> None:
        """Note each name in the element that nobody reads. Raises RefusedElement for a misspelt
        name."""
        if not place.text and _is_value(element.text):
            cause = f"<{element.tag}>: the text {element.text!r} is not read; it may move a body"
            self.note("unread", element, cause)
        for name, value in element.attributes.items():
            if not _is_idle(name, [value], place):
                where = f"attribute of <{element.tag}>"
                self._ask(place.attributes, name, where, element)
        for child in element.children:
            values = (child.text, *child.attributes.values())
            idle = not child.children and _is_idle(child.tag, values, place)
            if place.elements is not None and not idle:
                self._ask(place.elements, child.tag, f"<{element.tag}>", child, moves=place.moves)
            if child.tag in place.inside:
                self.look(child, place.inside[child.tag])
            elif child.tag == self.others or (
                place.elements is not None and child.tag in place.elements.harmless
            ):
                self._look_for_bodies(child, element, "geometry")

    def _look_for_bodies(self, element: Element, around: Element, part: str = "") -> None:
        """Note each body that is, or is in, an element that usually holds none. A name alone is a
        reference. part: what a body has there; "": anything."""
        if element.tag in (self.geometry, "include") and (
            element.all(part) if part else element.children
        ):
            self.note("unread", element, f"<{around.tag}>: the {element.tag} in it is not read")
            return
        for child in element.children:
            self._look_for_bodies(child, element)

    def _ask(
        self, names: Names, name: str, where: str, element: Element, *, moves: bool = False
    ) -> None:
        try:
            for message in names.unread([name], where):
                self.note("unread", element, message)
        except SatcheckError as error:
            if not moves:
                raise RefusedElement(
                    error.code, element.line, error.message, element.file
                ) from None
            self.note("unread", element, error.message)

    def issues(self) -> tuple[Issue, ...]:
        found = []
        for (code, cause, file), lines in self._lines.items():
            times = f" ({len(lines)} times)" if len(lines) > 1 else ""
            found.append(issue(code, f"line {lines[0]}: {cause}{times}", file=file))
        return tuple(found)


def _is_value(text: str) -> bool:
    return not text.strip(_IN_NUMBERS) and any(map(str.isdecimal, text))


def _is_idle(name: str, values: Iterable[str], place: Place) -> bool:
    if name not in place.idle:
        return False
    words = [word for value in values for word in value.split()]
    return all(_value(word) == place.idle[name] for word in words)


def _value(word: str) -> float | str:
    try:
        return float(word)
    except ValueError:
        return word.lower()
