"""Lines of plain text for a page: folded to its width, painted in its colours.

rich folds the few lines that do not fit, and is not imported for all others.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal

from rich.cells import cell_len

from satcheck.cli.output import harmless

if TYPE_CHECKING:
    from satcheck.cli.output import Page

# Codes of ANSI escape sequences (ECMA-48, SGR).
BOLD, GREEN, YELLOW, CYAN, BOLD_RED, BOLD_MAGENTA = "1", "32", "33", "36", "1;31", "1;35"


def paint(text: str, style: str) -> str:
    """The text between the escape sequences of a style; "" is none."""
    return f"\x1b[{style}m{text}\x1b[0m" if style else text


def fold(text: str, width: int, *, right: bool = False) -> list[str]:
    """Lines of exactly `width` cells, broken between words where possible."""
    from rich.console import Console
    from rich.text import Text

    justify: Literal["left", "right"] = "right" if right else "left"
    folded = Text(text).wrap(Console(width=width), width, justify=justify, overflow="fold")
    return [line.plain for line in folded]


def fitted(text: str, page: Page, style: str = "") -> list[str]:
    """The text as lines of the page."""
    lines = [
        line
        for whole in text.split("\n")
        for line in ([whole] if cell_len(whole) <= page.width else fold(whole, page.width))
    ]
    return [paint(line, style if page.colour else "") for line in lines]


def joined(lines: Iterable[str], page: Page) -> str:
    """One text, without blanks at the ends of lines and what a terminal would obey."""
    return "".join(f"{harmless(line, colour=page.colour).rstrip()}\n" for line in lines)
