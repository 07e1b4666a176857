"""Harmless mistakes of a file: one warning for each cause, however often it occurs."""

from __future__ import annotations

from satcheck.scene.issue import Issue, issue
from satcheck.scene.robot.xml_tree import Element


class Slips:
    """Collects slips in the order of the file."""

    def __init__(self) -> None:
        self._lines: dict[tuple[str, str], list[int]] = {}

    def note(self, code: str, element: Element, cause: str) -> None:
        self._lines.setdefault((code, cause), []).append(element.line)

    def issues(self, file: str) -> tuple[Issue, ...]:
        return tuple(
            issue(code, f"line {lines[0]}: {cause}{_more(lines)}", file=file)
            for (code, cause), lines in self._lines.items()
        )


def _more(lines: list[int]) -> str:
    return f" ({len(lines)} times)" if len(lines) > 1 else ""
