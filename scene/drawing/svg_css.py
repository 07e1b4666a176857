"""Style sheets of SVG: which rules set what a shape depends on. Source: W3C, "CSS 2.1", chapter 5.

Selectors of names, classes, ids and attributes, descendants and children are read. A rule with any
other is left out where it sets nothing that a shape depends on, and refused where it does.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from xml.etree.ElementTree import Element

from satcheck.core.frozen import frozen
from satcheck.scene.drawing.svg_values import unread

# What is drawn, and where: by its value, or it may not be set by style at all.
READ = frozenset({"clip-path", "display", "fill", "fill-rule", "mask", "visibility"})
MOVING = frozenset(
    {"cx", "cy", "d", "height", "r", "rx", "ry", "width", "x", "y"}
    | {"all", "offset", "offset-path", "perspective", "rotate", "scale", "transform"}
    | {"transform-box", "transform-origin", "translate", "zoom"}
)

_HIDING = re.compile(r"/\*.*?\*/|<!--|-->", re.DOTALL)
_QUOTED = re.compile(r"url\([^)]*\)|\"[^\"]*\"|'[^']*'")
_BLOCK = re.compile(r"\s*([^{};]*)(?:\{((?:[^{}]|\{[^{}]*\})*)\}|;)")
_IDENTIFIER = r"[A-Za-z_\-\u0080-\U0010ffff][\w\-\u0080-\U0010ffff]*"
_SIMPLE = re.compile(
    rf"(\*|{_IDENTIFIER})|\.({_IDENTIFIER})|#({_IDENTIFIER})|\[({_IDENTIFIER})(?:=([^\]]*))?\]"
)
_COMPOUND = re.compile(
    rf"(?:\*|{_IDENTIFIER})?(?:[.#]{_IDENTIFIER}|\[{_IDENTIFIER}(?:=[^\]]*)?\])*"
)
_NEVER_AT_REST = re.compile(r":(?:hover|active|focus|focus-within|focus-visible|visited)\b")
_HARMLESS = ("@charset", "@font-face", "@namespace")


@frozen
class Declaration:
    """weight: what has the larger one wins: important, specificity, place."""

    key: str
    value: str
    weight: tuple[int, ...]


@frozen
class Rule:
    """steps: alternately a compound selector and " " or ">", the last one that of the element."""

    steps: tuple[str, ...]
    declarations: tuple[Declaration, ...]


def declarations(text: str, specificity: tuple[int, ...]) -> Iterator[Declaration]:
    """Those of READ and MOVING. Raises MeshFileError."""
    text = _QUOTED.sub("quoted", _HIDING.sub(" ", text))
    for place, part in enumerate(text.split(";")):
        key, colon, value = part.partition(":")
        key, value = key.strip().lower(), value.strip().lower()
        if not colon or not value or key not in READ | MOVING:
            continue
        if "var(" in value or "\\" in value:
            raise unread(f"style {key}: {value!r} is not read")
        value, mark, important = value.partition("!")
        is_important = bool(mark) and important.strip() == "important"
        yield Declaration(key, value.strip(), (int(is_important), *specificity, place))


def rules_of(sheet: str, first: int) -> list[Rule]:
    """first: the number of the first rule, for those that weigh the same. Raises MeshFileError."""
    text = _HIDING.sub(" ", sheet)
    strings: list[str] = []

    def put_away(found: re.Match[str]) -> str:
        strings.append(found[0])
        return f"\0{len(strings) - 1}\0"

    def put_back(text: str) -> str:
        return re.sub(r"\0(\d+)\0", lambda found: strings[int(found[1])], text)

    text = _QUOTED.sub(put_away, text)
    rules: list[Rule] = []
    end = 0
    while block := _BLOCK.match(text, end):
        end = block.end()
        head, body = block[1].strip(), put_back(block[2] or "")
        if head.startswith("@"):
            _check_at_rule(head, body)
            continue
        for selector in filter(None, map(str.strip, put_back(head).split(","))):
            rules += _rule(selector, body, first + len(rules))
    if text[end:].strip():
        raise unread(f"style sheet: {put_back(text[end:].strip())[:40]!r} is not read")
    return rules


def _check_at_rule(head: str, body: str) -> None:
    if " ".join(head.split()) == "@media print" or head.startswith(_HARMLESS):
        return
    words = set(re.findall(r"[\w-]+(?=\s*:)", body))
    if head.startswith("@import") or words & (READ | MOVING):
        raise unread(f"style sheet: {head[:40]!r} is not read")


def _rule(selector: str, body: str, number: int) -> Iterator[Rule]:
    steps = _steps(selector)
    if steps is None and _NEVER_AT_REST.search(selector):
        return
    specificity = _specificity(steps or ())
    found = tuple(declarations(body, (0, *specificity, number)))
    if not found:
        return
    if steps is None:
        raise unread(
            f"style sheet: {selector[:60]!r} sets {found[0].key}: no selector that is read"
        )
    yield Rule(steps, found)


def _steps(selector: str) -> tuple[str, ...] | None:
    words = re.sub(r"\s*>\s*", " > ", selector).split()
    steps: list[str] = []
    for word in words:
        if word == ">":
            if not steps or steps[-1] == ">":
                return None
            steps.append(">")
        elif _COMPOUND.fullmatch(word):
            if steps and steps[-1] != ">":
                steps.append(" ")
            steps.append(word)
        else:
            return None
    return tuple(steps) if steps and steps[-1] != ">" else None


def _specificity(steps: tuple[str, ...]) -> tuple[int, int, int]:
    ids = classes = names = 0
    for step in steps[::2]:
        for name, kind, id_, attribute, _ in _SIMPLE.findall(step):
            ids += bool(id_)
            classes += bool(kind or attribute)
            names += bool(name) and name != "*"
    return ids, classes, names


def matches(rule: Rule, element: Element, parents: Mapping[Element, Element]) -> bool:
    return _matches(rule.steps, element, parents)


def _matches(steps: tuple[str, ...], element: Element, parents: Mapping[Element, Element]) -> bool:
    if not _is(steps[-1], element):
        return False
    if len(steps) == 1:
        return True
    above = parents.get(element)
    while above is not None:
        if _matches(steps[:-2], above, parents):
            return True
        if steps[-2] == ">":
            return False
        above = parents.get(above)
    return False


def _is(compound: str, element: Element) -> bool:
    for name, kind, id_, attribute, value in _SIMPLE.findall(compound):
        if name and name not in ("*", str(element.tag).rpartition("}")[2]):
            return False
        if kind and kind not in element.get("class", "").split():
            return False
        if id_ and id_ != element.get("id"):
            return False
        if attribute and attribute not in element.attrib:
            return False
        if attribute and value and element.get(attribute) != value.strip("\"'"):
            return False
    return True
