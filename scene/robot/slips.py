"""Harmless mistakes of a robot file."""

from __future__ import annotations

from collections.abc import Collection

from satcheck.scene.issue import Issue, issue
from satcheck.scene.robot.xml_tree import Element
from satcheck.scene.words import meant


class Slips:
    """Collects harmless mistakes in file order, with one warning for each cause."""

    def __init__(self) -> None:
        self._lines: dict[tuple[str, str, str], list[int]] = {}

    def note(self, code: str, element: Element, cause: str) -> None:
        self._lines.setdefault((code, cause, element.file), []).append(element.line)

    def note_unknown(
        self, element: Element, known: Collection[str], others: Collection[str] = ()
    ) -> None:
        """Notes children with unknown names. others: more known names, which no hint suggests.

        Names with a prefix belong to other programs.
        """
        for child in element.children:
            if child.tag not in known and child.tag not in others and ":" not in child.tag:
                hint = meant(child.tag, known)
                cause = f"unknown <{child.tag}> in <{element.tag}>{hint}: ignored"
                self.note("unknown-element", child, cause)

    def issues(self) -> tuple[Issue, ...]:
        return tuple(
            issue(code, f"line {lines[0]}: {cause}{_more(lines)}", file=file)
            for (code, cause, file), lines in self._lines.items()
        )


def _more(lines: list[int]) -> str:
    return f" ({len(lines)} times)" if len(lines) > 1 else ""
