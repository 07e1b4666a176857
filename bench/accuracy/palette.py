"""Colours of the figures, by class: told apart by readers who confuse red and green, on light and
on dark paper (after Okabe and Ito, Color Universal Design, 2008)."""

from __future__ import annotations

# Sound rungs, convex parts, the Boolean; and what is wrong.
_SERIES = {
    "sound": ("#0a62c9", "#58a6ff"),
    "parts": ("#8f5f00", "#e3b341"),
    "boolean": ("#59636e", "#9198a1"),
    "wrong": ("#d1410c", "#ff8a5c"),
}
# What became of a rung, in the order of verdicts.OUTCOMES.
_OUTCOMES = {
    "right": ("#0072b2", "#4aa8e0"),
    "false": ("#e69f00", "#e69f00"),
    "miss": ("#b0005b", "#ff7ab8"),
    "undecided": ("#8c959f", "#8b949e"),
    "unjudged": ("#bcd7ee", "#2f5878"),
    "failed": ("#5c6570", "#c3cad2"),
    "left": ("#e4e8ec", "#30363d"),
}
# Stages of a check, in the order of stages.GROUPS, and what is none of these.
STAGE_COLOURS = (
    ("#999999", "#8a8a8a"),
    ("#d9d9d9", "#c9c9c9"),
    ("#f0e442", "#d9cd3a"),
    ("#e69f00", "#e69f00"),
    ("#56b4e9", "#56b4e9"),
    ("#0072b2", "#3d8fd1"),
    ("#009e73", "#1fb58a"),
    ("#cc79a7", "#cc79a7"),
    ("#ffffff", "#000000"),
)

Rules = dict[str, str]


def series() -> tuple[Rules, Rules]:
    """Rules for light and dark: `x-fill`, `x-line` (a stroke), `x-open` (paper, outlined)."""
    made: tuple[Rules, Rules] = ({}, {})
    for name, colours in _SERIES.items():
        for rules, colour, paper in zip(made, colours, ("#ffffff", "#0d1117"), strict=True):
            rules[f"{name}-fill"] = f"fill: {colour};"
            rules[f"{name}-line"] = f"fill: none; stroke: {colour};"
            rules[f"{name}-open"] = f"fill: {paper}; stroke: {colour}; stroke-width: 1.5;"
    return made


def filled(names: list[str], colours: list[tuple[str, str]]) -> tuple[Rules, Rules]:
    light = {name: f"fill: {pair[0]};" for name, pair in zip(names, colours, strict=True)}
    dark = {name: f"fill: {pair[1]};" for name, pair in zip(names, colours, strict=True)}
    return light, dark


def outcomes() -> tuple[Rules, Rules]:
    """`x` for bars, `on-x` for letters on them."""
    made = filled(list(_OUTCOMES), list(_OUTCOMES.values()))
    for rules, pale in zip(made, (("right", "miss", "failed"), ("unjudged", "left")), strict=True):
        for name in _OUTCOMES:
            rules[f"on-{name}"] = f"fill: {'#ffffff' if name in pale else '#101418'};"
    return made


OUTCOME_CLASSES = tuple(_OUTCOMES)
