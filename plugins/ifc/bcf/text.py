"""XML elements of BCF."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement, tostring

from satcheck.cli.output import harmless


def below(parent: Element, tag: str, text: str | None = None, **attributes: str) -> Element:
    """A new last child."""
    element = SubElement(parent, tag, {k: harmless(v) for k, v in attributes.items()})
    if text is not None:
        element.text = "\n".join(map(harmless, text.split("\n")))
    return element


def point(parent: Element, tag: str, coordinates: tuple[float, ...]) -> None:
    element = below(parent, tag)
    for axis, value in zip("XYZ", coordinates, strict=True):
        below(element, axis, repr(float(value)))


def document(root: Element) -> bytes:
    text = tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}'.encode()
