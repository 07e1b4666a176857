"""The page on which a renderer lays out text. It prints nothing."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from rich.console import Console

from satcheck.cli.output import harmless

if TYPE_CHECKING:
    from satcheck.cli.output import Page


class Canvas(Console):
    """A console as wide and as colourful as a page, which keeps what is printed on it."""

    def __init__(self, page: Page) -> None:
        self._written = io.StringIO()
        super().__init__(
            file=self._written,
            width=page.width,
            force_terminal=page.colour,
            color_system="standard" if page.colour else None,
            no_color=not page.colour,
            legacy_windows=False,
            highlight=False,
            emoji=False,
            markup=False,
        )

    def text(self) -> str:
        """All of it, without blanks at the ends of lines; final newline included."""
        lines = self._written.getvalue().removesuffix("\n").split("\n")
        return "".join(f"{harmless(line, colour=not self.no_color).rstrip()}\n" for line in lines)
