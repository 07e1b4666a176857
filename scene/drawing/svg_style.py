"""Computes the style of an element from its attributes and style sheets. tinycss2 parses the rules,
and cssselect2 matches them to elements. A rule that they do not understand is refused if it sets a
property that a shape depends on, and is ignored otherwise. Source: W3C, "SVG 1.1", chapter 6.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any
from xml.etree.ElementTree import Element

import cssselect2
import tinycss2
from msgspec import Struct

from satcheck.scene.drawing.contour import FillRule
from satcheck.scene.drawing.svg_values import unread

# Properties whose values are read. All other properties that move or change a shape are refused
# in styles.
_READ = frozenset({"clip-path", "display", "fill", "fill-rule", "mask", "visibility"})
_MOVING = frozenset(
    {"cx", "cy", "d", "height", "r", "rx", "ry", "width", "x", "y"}
    | {"all", "offset", "offset-path", "perspective", "rotate", "scale", "transform"}
    | {"transform-box", "transform-origin", "translate", "zoom"}
)
_HARMLESS_RULES = frozenset({"charset", "font-face", "namespace"})
_SHOWN = frozenset({"inline", "block", "inline-block", "list-item", "flex", "grid", "table"})
_FILL_RULES: dict[str, FillRule] = {"nonzero": "nonzero", "evenodd": "evenodd"}
_SIZE = frozenset({"width", "height"})  # of the outermost element
_OF_TRANSFORM = frozenset({"transform-origin", "transform-box"})
_HARMLESS_VALUES = {"transform": "none", "transform-origin": "0 0"}


class Style(Struct, frozen=True):
    """The computed style. is_cut: a clip path or a mask cuts the element."""

    is_displayed: bool = True
    is_visible: bool = True
    is_filled: bool = True
    rule: FillRule = "nonzero"
    is_cut: bool = False


class _Declaration(Struct, frozen=True):
    key: str
    value: str
    important: bool = False


class StyleSheets:
    """All rules of a document. Raises MeshFileError for unsupported rules."""

    def __init__(self, sheets: Iterable[str], root: Element) -> None:
        elements = cssselect2.ElementWrapper.from_xml_root(root).iter_subtree()
        self._elements = {wrapper.etree_element: wrapper for wrapper in elements}
        self._matcher = cssselect2.Matcher()
        for sheet in sheets:
            for rule in tinycss2.parse_stylesheet(sheet, True, True):
                self._add(rule)

    def _add(self, rule: Any) -> None:
        if rule.type != "qualified-rule":
            _check_other_rule(rule)
            return
        declarations = tuple(_declarations(rule.content))
        try:
            for selector in cssselect2.compile_selector_list(rule.prelude):
                self._matcher.add_selector(selector, declarations)
        except cssselect2.SelectorError:
            if declarations:
                selector = tinycss2.serialize(rule.prelude).strip()[:60]
                key = declarations[0].key
                message = f"style sheet: {selector!r} sets {key}: this selector is not read"
                raise unread(message) from None

    def style_of(self, element: Element, above: Style, is_root: bool) -> Style:
        """above: the style of its parent. Raises MeshFileError for unsupported styles."""
        values = self.values_of(element)
        for key in sorted(_MOVING & values.keys()):
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
        """The properties set at the element itself that its outline depends on.

        Rules override attributes, the style attribute overrides rules, and `!important` overrides
        all.
        """
        declarations = [
            _Declaration(key, value.strip().lower())
            for key, value in element.attrib.items()
            if value.strip() and (key in _READ or key == "transform-origin")
        ]
        for _, _, pseudo, rule in self._matcher.match(self._elements[element]):
            declarations += rule if pseudo is None else ()
        declarations += _declarations(element.get("style", ""))
        declarations.sort(key=lambda declaration: declaration.important)
        values = {declaration.key: declaration.value for declaration in declarations}
        for key, value in _HARMLESS_VALUES.items():
            if values.get(key) == value:
                del values[key]
        return values


def _check_other_rule(rule: Any) -> None:
    text = rule.serialize() if rule.type == "at-rule" else rule.message
    name = rule.lower_at_keyword if rule.type == "at-rule" else ""
    is_print = name == "media" and tinycss2.serialize(rule.prelude).strip().lower() == "print"
    if name in _HARMLESS_RULES or is_print:
        return
    keys = set(re.findall(r"[\w-]+(?=\s*:)", text))
    if not name or name == "import" or keys & (_READ | _MOVING):
        raise unread(f"style sheet: {text[:40]!r} is not read")


def _declarations(block: Any) -> Iterator[_Declaration]:
    """The declarations of properties in _READ and _MOVING. Raises MeshFileError."""
    for node in tinycss2.parse_blocks_contents(block, True, True):
        if node.type in ("at-rule", "qualified-rule"):
            raise unread(f"style: {node.serialize()[:40]!r} is not read")
        if node.type != "declaration" or node.lower_name not in _READ | _MOVING:
            continue
        value = tinycss2.serialize(node.value).strip().lower()
        if "var(" in value or "\\" in value:
            raise unread(f"style {node.lower_name}: {value!r} is not read")
        if value:
            yield _Declaration(node.lower_name, value, node.important)


def _inherited(values: Mapping[str, str], key: str, above: str, initial: str = "visible") -> str:
    value = values.get(key, "inherit")
    if value in ("inherit", "unset"):
        return above
    return initial if value == "initial" else value
