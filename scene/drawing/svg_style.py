"""What attributes, style and style sheets say of an element. Source: W3C, "SVG 1.1", chapter 6."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from xml.etree.ElementTree import Element

from satcheck.core.frozen import frozen
from satcheck.scene.drawing.contour import FillRule
from satcheck.scene.drawing.svg_css import (
    MOVING,
    READ,
    Declaration,
    Rule,
    declarations,
    matches,
    rules_of,
)
from satcheck.scene.drawing.svg_values import unread

# Presentation attributes weigh less than any rule, the style attribute more.
_ATTRIBUTE, _STYLE = (0, -1), (1,)
_SHOWN = frozenset({"inline", "block", "inline-block", "list-item", "flex", "grid", "table"})
_FILL_RULES: dict[str, FillRule] = {"nonzero": "nonzero", "evenodd": "evenodd"}
_SIZE = frozenset({"width", "height"})  # of the outermost element: shapes keep their user units
_OF_TRANSFORM = frozenset({"transform-origin", "transform-box"})
_HARMLESS_VALUES = {"transform": "none", "transform-origin": "0 0"}


@frozen
class Style:
    """As computed. is_cut: by a clip path or a mask."""

    is_displayed: bool = True
    is_visible: bool = True
    is_filled: bool = True
    rule: FillRule = "nonzero"
    is_cut: bool = False


class StyleSheets:
    """All rules of a document; parents: of each of its elements but the root."""

    def __init__(self, sheets: Iterable[str], parents: Mapping[Element, Element]) -> None:
        self._rules: list[Rule] = []
        self._parents = parents
        for sheet in sheets:
            self._rules += rules_of(sheet, len(self._rules))

    def style_of(self, element: Element, above: Style, is_root: bool) -> Style:
        """above: of the element that it is drawn in. Raises MeshFileError for what is not read."""
        values = self.values_of(element)
        for key in sorted(MOVING & values.keys()):
            if (is_root and key in _SIZE) or (
                key in _OF_TRANSFORM and not element.get("transform")
            ):
                continue
            raise unread(f"{key} as a style is not read")
        display = values.get("display", "inline")
        if display not in _SHOWN | {"none", "inherit", "initial", "unset"}:
            raise unread(f"display: {display!r} is not read")
        visibility = _inherited(values, "visibility", "visible" if above.is_visible else "hidden")
        if visibility not in ("visible", "hidden", "collapse"):
            raise unread(f"visibility: {visibility!r} is not read")
        rule = _inherited(values, "fill-rule", above.rule, "nonzero")
        if rule not in _FILL_RULES:
            raise unread(f"fill-rule: {rule!r} is not read")
        fill = _inherited(values, "fill", "black" if above.is_filled else "none", "black")
        cuts = (values.get(key, "none") for key in ("clip-path", "mask"))
        return Style(
            display != "none",
            visibility == "visible",
            fill != "none",
            _FILL_RULES[rule],
            any(cut not in ("none", "initial", "unset", "") for cut in cuts),
        )

    def values_of(self, element: Element) -> dict[str, str]:
        """What is set at the element itself, of the properties that its outline depends on."""
        found = [
            Declaration(key, value.strip().lower(), _ATTRIBUTE)
            for key, value in element.attrib.items()
            if value.strip() and (key in READ or key == "transform-origin")
        ]
        for rule in self._rules:
            if matches(rule, element, self._parents):
                found += rule.declarations
        found += declarations(element.get("style", ""), _STYLE)
        found.sort(key=lambda one: one.weight)
        values = {one.key: one.value for one in found}
        for key, value in _HARMLESS_VALUES.items():
            if values.get(key) == value:
                del values[key]
        return values


def _inherited(values: Mapping[str, str], key: str, above: str, initial: str = "visible") -> str:
    value = values.get(key, "inherit")
    if value in ("inherit", "unset"):
        return above
    return initial if value == "initial" else value
