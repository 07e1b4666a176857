"""What the judges count, one row a category, and the table of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field


@dataclass(slots=True)
class Score:
    """cases: pairs. answers: queries made on them and on their isometric variants.

    wrong: another outcome than the truth. undecided: no outcome. outside: the reported interval
    misses the true signed distance. blocked: the reported way out does not separate. varied: an
    isometric variant got another answer. error: the largest |distance - truth| over the size of the
    pair; share: the largest over what the reported interval grants. Each failure is named.
    """

    category: str
    cases: int = 0
    answers: int = 0
    wrong: int = 0
    undecided: int = 0
    outside: int = 0
    blocked: int = 0
    varied: int = 0
    error: float = 0.0
    share: float = 0.0
    failures: list[str] = field(default_factory=list)

    def fail(self, kind: str, what: str) -> None:
        """kind: the name of a counter."""
        setattr(self, kind, getattr(self, kind) + 1)
        self.failures.append(f"{kind}: {what}")


HEAD = ("category", "pairs", "wrong", "undecided", "worst error / size", "error / bound")


def row(score: Score) -> tuple[str, ...]:
    wrong = score.wrong + score.outside + score.blocked + score.varied
    return (
        score.category,
        str(score.cases),
        str(wrong),
        str(score.undecided),
        rounded_up(score.error),
        rounded_up(score.share),
    )


def rounded_up(value: float) -> str:
    """Two digits, never less than the value."""
    if value == 0:
        return "0"
    text = f"{value:.1e}"
    if float(text) < value:
        mantissa, exponent = text.split("e")
        text = f"{float(mantissa) + 0.1:.1f}e{exponent}"
    return f"{float(text):g}"


def table(scores: Iterable[Score]) -> str:
    """Markdown."""
    rows = [HEAD, ("---",) * len(HEAD), *(row(score) for score in scores)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in rows)
