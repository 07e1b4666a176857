"""What became of each rung, pair by pair: one bar a rung."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from bench.accuracy.palette import OUTCOME_CLASSES, outcomes
from bench.accuracy.rungs import RungSummary
from bench.accuracy.verdicts import OUTCOMES
from bench.drawing import figure, rectangle, text

WIDTH, LEFT, RIGHT = 760.0, 96.0, 736.0
TOP, ROW, BAR = 82.0, 27.0, 19.0
_LETTER = 6.8  # of a label, in pixels
WORDS = {
    "right": "right",
    "false hit": "false hit",
    "miss": "miss",
    "undecided": "undecided",
    "not judged": "touching, or truth not known",
    "failed": "refused",
    "not run": "out of budget",
}


def draw(rungs: Sequence[RungSummary]) -> str:
    pairs = sum(rungs[0].outcomes.values())
    parts = [
        text(16, 24, f"Yes or no, of {pairs} pairs", "start", "head"),
        *_legend(),
    ]
    for k, rung in enumerate(rungs):
        parts += _bar(rung, TOP + k * ROW, (RIGHT - LEFT) / pairs)
    return figure(WIDTH, TOP + len(rungs) * ROW + 12, "Verdicts by rung", parts, outcomes())


def _bar(rung: RungSummary, y: float, wide: float) -> Iterator[str]:
    yield text(LEFT - 8, y + 14, rung.label)
    x = LEFT
    for kind, name in zip(OUTCOMES, OUTCOME_CLASSES, strict=True):
        count = rung.outcomes[kind]
        if count:
            hint = f"{rung.label}: {count} {WORDS[kind]}"
            yield rectangle(x, y, max(count * wide - 1, 1), BAR, name, hint)
            if count * wide > _LETTER * len(str(count)) + 4:
                kind_of_text = f"on-{name}"
                yield text(x + 0.5 * count * wide, y + 14, str(count), "middle", kind_of_text)
        x += count * wide


def _legend() -> Iterator[str]:
    x, y = 16.0, 40.0
    for kind, name in zip(OUTCOMES, OUTCOME_CLASSES, strict=True):
        words = WORDS[kind]
        if x + 22 + _LETTER * len(words) > WIDTH:
            x, y = 16.0, y + 18
        yield rectangle(x, y, 12, 12, name)
        yield text(x + 17, y + 10.5, words, "start")
        x += 32 + _LETTER * len(words)
