"""Colours of the figures, on light and on dark paper: told apart by readers who confuse red and
green (after Okabe and Ito, Color Universal Design, 2008)."""

from __future__ import annotations

from bench.accuracy.verdicts import OUTCOMES, Outcome

Colours = dict[str, str]
_Pairs = dict[str, tuple[str, str]]

# Sound rungs, convex parts, the Boolean; and what is wrong.
_SERIES: _Pairs = {
    "sound": ("#0a62c9", "#58a6ff"),
    "parts": ("#8f5f00", "#e3b341"),
    "boolean": ("#59636e", "#9198a1"),
    "wrong": ("#d1410c", "#ff8a5c"),
}
_OUTCOMES: dict[Outcome, tuple[str, str]] = {
    "right": ("#0072b2", "#4aa8e0"),
    "false hit": ("#e69f00", "#e69f00"),
    "miss": ("#b0005b", "#ff7ab8"),
    "undecided": ("#8c959f", "#8b949e"),
    "not judged": ("#bcd7ee", "#2f5878"),
    "failed": ("#5c6570", "#c3cad2"),
    "not run": ("#e4e8ec", "#30363d"),
}
# In the order of stages.GROUPS, and what is none of these.
_STAGES = (
    ("#999999", "#8a8a8a"),
    ("#d9d9d9", "#c9c9c9"),
    ("#f0e442", "#d9cd3a"),
    ("#e69f00", "#e69f00"),
    ("#56b4e9", "#56b4e9"),
    ("#0072b2", "#3d8fd1"),
    ("#009e73", "#1fb58a"),
    ("#cc79a7", "#cc79a7"),
    ("#f6f8fa", "#000000"),
)


def series(*, dark: bool) -> Colours:
    return {name: pair[dark] for name, pair in _SERIES.items()}


def outcomes(*, dark: bool) -> list[str]:
    """In the order of OUTCOMES."""
    return [_OUTCOMES[outcome][dark] for outcome in OUTCOMES]


def stages(*, dark: bool) -> list[str]:
    return [pair[dark] for pair in _STAGES]


def kind_of(label: str) -> str:
    """The colour of a rung in `series`."""
    return "parts" if label.startswith("parts") else "boolean" if label == "boolean" else "sound"


def ink_on(colour: str) -> str:
    """Letters on a bar: dark, or white where the bar is dark (relative luminance of sRGB)."""
    red, green, blue = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return "#101418" if 0.2126 * red + 0.7152 * green + 0.0722 * blue > 118 else "#ffffff"
