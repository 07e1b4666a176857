"""The result of `satcheck stability` as text: a row for each family, the failures, a summary."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich import box
from rich.table import Table
from rich.text import Text

from satcheck.cli.formats.canvas import Canvas
from satcheck.cli.formats.numbers import bounds, number, vector
from satcheck.cli.formats.words import counted

if TYPE_CHECKING:
    from satcheck.cli.output import Page
    from satcheck.studies.stability import Answer, Family, FamilyResult, Sample, Stability

_QUESTIONS: dict[Family, str] = {
    "scale": "times powers of two",
    "order": "vertices, faces reordered",
    "axes": "axes exchanged, mirrored",
    "swap": "A and B swapped",
    "translation": "moved, exactly",
    "retessellation": "other triangles",
    "motion": "turned and moved",
    "noise": "1 ulp of noise",
}
_COLOURS = {"same": "green", "within": "green", "beyond": "bold red", "undecided": "bold magenta"}


def render(result: Stability, page: Page, *, explain: bool) -> str:
    """The whole text, final newline included."""
    console = Canvas(page)
    console.print(f"{result.a} against {result.b}: {answer_line(result.answer)}")
    if result.in_band:
        band = f"the tolerance {number(result.band)}, and stability uses none"
        console.print(f"A plain check says touching: that is within {band}.")
    console.print(_families(result, unicode=page.unicode))
    for family in result.families:
        for sample in family.samples:
            if explain or sample.comparison.judgement in ("beyond", "undecided"):
                console.print(f"  {_sample_line(family, sample)}")
        if family.skipped:
            console.print(f"  {_QUESTIONS[family.family]}: not asked, {family.skipped}")
    console.print(_summary(result))
    return console.text()


def answer_line(answer: Answer) -> str:
    """`penetrating, depth 1, thickness 1, move A by (-1, 0, 0)`."""
    parts: list[str] = [answer.relation]
    if answer.reason:
        parts.append(answer.reason)
    if answer.distance is not None and answer.relation == "separated":
        parts.append(f"gap {number(answer.distance)}")
    if answer.depth_bounds is not None:
        parts.append(f"depth {bounds(*answer.depth_bounds)}")
    if answer.thickness_bounds is not None:
        parts.append(f"thickness {bounds(*answer.thickness_bounds)}")
    if answer.mtv is not None:
        parts.append(f"move A by {vector(answer.mtv)}")
    return ", ".join(parts)


def _families(result: Stability, *, unicode: bool) -> Table:
    table = Table(header_style="bold", box=box.ROUNDED if unicode else box.ASCII)
    table.add_column("asked again")
    table.add_column("samples", justify="right")
    table.add_column("relation")
    table.add_column("changed by", justify="right")
    table.add_column("may be", justify="right")
    thick = result.answer.thickness_bounds is not None
    if thick:
        table.add_column("thickness by", justify="right")
    table.add_column("verdict")
    for family in result.families:
        if family.samples:
            judgement = family.judgement or ""
            table.add_row(
                _QUESTIONS[family.family],
                str(len(family.samples)),
                _relations(family),
                _length(family.change),
                _small(family.bound),
                *([_length(family.thickness_change)] if thick else []),
                Text(judgement, style=_COLOURS.get(judgement, "")),
            )
    return table


def _relations(family: FamilyResult) -> str:
    seen = family.relations
    if len(seen) == 1:
        return next(iter(seen))
    return ", ".join(f"{count} {relation}" for relation, count in sorted(seen.items()))


def _length(change: float | None) -> str:
    return "" if change is None else _small(change)


def _small(length: float) -> str:
    return "0" if length == 0 else f"{length:.2g}"


def _sample_line(family: FamilyResult, sample: Sample) -> str:
    comparison = sample.comparison
    line = f"{_QUESTIONS[family.family]}, {sample.how}: {answer_line(sample.answer)}"
    if not comparison.beyond:
        return f"{line} ({comparison.judgement})"
    change = f" by {_small(comparison.change)}" if comparison.change else ""
    return f"{line} ({' and '.join(comparison.beyond)} changed{change}, beyond the bound)"


def _summary(result: Stability) -> str:
    asked = f"Asked in {counted(result.sample_count, 'other way')} (seed {result.seed})"
    beyond = sum(s.comparison.judgement == "beyond" for f in result.families for s in f.samples)
    unknown = sum(s.comparison.judgement == "undecided" for f in result.families for s in f.samples)
    if beyond:
        return f"{asked}: {counted(beyond, 'answer')} changed beyond the bound."
    if unknown:
        return f"{asked}: {counted(unknown, 'comparison')} could not be made."
    return f"{asked}: nothing changed beyond its bound."
