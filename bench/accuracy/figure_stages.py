"""Where the time of a plain check goes: one bar a kind of pair."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from bench.accuracy.palette import STAGE_COLOURS, filled
from bench.accuracy.stages import GROUPS, OTHER, StageTimes
from bench.drawing import figure, rectangle, text
from satcheck.cli.report.numbers import duration

WIDTH, LEFT, RIGHT = 760.0, 24.0, 736.0
TOP, ROW, BAR = 84.0, 62.0, 30.0
_LETTER = 6.8
_MICROSECONDS = 1e6
_CLASSES = [f"stage{k}" for k in range(len(STAGE_COLOURS))]


def draw(kinds: Sequence[StageTimes]) -> str:
    parts = [
        text(16, 24, "Where the time of a plain check goes, from files to report", "start", "head"),
        *_legend(kinds),
    ]
    for k, kind in enumerate(kinds):
        parts += _bar(kind, TOP + k * ROW)
    rules = filled(_CLASSES, list(STAGE_COLOURS))
    for one in rules:
        # Ink on every stage: dark letters, but for the one dark stage.
        one["on"] = "fill: #101418;"
        one["on-dark"] = "fill: #ffffff;"
    return figure(WIDTH, TOP + len(kinds) * ROW + 4, "Stages of a check", parts, rules)


def _class_of(group: str) -> str:
    return _CLASSES[[*GROUPS, OTHER].index(group)]


def _bar(kind: StageTimes, y: float) -> Iterator[str]:
    total = kind.total
    quartiles = " .. ".join(duration(_MICROSECONDS * end) for end in (total.first, total.third))
    said = f"median {duration(_MICROSECONDS * total.median)}, quartiles {quartiles}"
    yield text(LEFT, y, f"{kind.kind}: {kind.pairs} pairs, {said}", "start", "title")
    x, wide = LEFT, RIGHT - LEFT
    for group, share in kind.shares.items():
        words = f"{100 * share:.0f} %"
        hint = f"{kind.kind}: {group} {words}"
        yield rectangle(x, y + 8, max(share * wide - 1, 0.5), BAR, _class_of(group), hint)
        if share * wide > _LETTER * len(words) + 6:
            ink = "on-dark" if group == "depth search" else "on"
            yield text(x + 0.5 * share * wide, y + 28, words, "middle", ink)
        x += share * wide


def _legend(kinds: Sequence[StageTimes]) -> Iterator[str]:
    shown = {group for kind in kinds for group in kind.shares}
    x = 16.0
    for group in (*GROUPS, OTHER):
        if group in shown:
            yield rectangle(x, 42, 12, 12, _class_of(group))
            yield text(x + 17, 52.5, group, "start")
            x += 30 + _LETTER * len(group)
