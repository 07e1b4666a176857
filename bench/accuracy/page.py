"""The page: what accuracy costs, in sentences, figures and tables, of the records of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from bench.accuracy import figure_bars, figure_ladder, figure_rungs, words
from bench.accuracy.rungs import (
    EXACT,
    PARTS,
    Cost,
    RungSummary,
    Step,
    cost,
    hard,
    labels,
    step,
    summary,
)
from bench.accuracy.sections import (
    HULL,
    next_factor,
    of_rungs,
    of_silence,
    of_the_default,
    of_the_truth,
    of_verdicts,
)
from bench.accuracy.stages import stage_times
from bench.accuracy.verdicts import overlaps
from bench.drawing import both
from satcheck.audit.words import counted

Record = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Page:
    """text: Markdown, with links into a folder; figures: SVG by the name of its file there."""

    text: str
    figures: dict[str, bytes]


@dataclass(frozen=True, slots=True)
class Run:
    """header: of the results. records: of the pairs, failures included. corpora: each in words,
    with the number of its pairs. about: a sentence on them. command: what makes the page again.
    folder: of the figures, as the page links to it."""

    header: dict[str, Any]
    records: Sequence[Record]
    corpora: Sequence[str]
    about: str
    command: str
    folder: str


def page(run: Run) -> Page:
    records = [one for one in run.records if "pair" in one]
    concave = hard(records)
    found = {label: summary(records, label) for label in labels(records)}
    apart, overlapping = _sides(concave)
    rungs, kinds = list(found.values()), stage_times(records)
    drawn = {
        **both("ladder", lambda dark: figure_ladder.draw(apart, overlapping, dark=dark)),
        **both("rungs", lambda dark: figure_rungs.draw(records, rungs, dark=dark)),
        **both("verdicts", lambda dark: figure_bars.draw_verdicts(rungs, dark=dark)),
        **both("stages", lambda dark: figure_bars.draw_stages(kinds, dark=dark)),
    }
    sections = [
        _opening(run, records, concave),
        next_factor(run.folder, records, concave),
        of_rungs(run.folder, found),
        of_verdicts(run.folder, found),
        of_the_default(run.folder, records),
        of_silence(records),
        of_the_truth(records),
        _making(run, records, found),
    ]
    return Page("\n\n".join(sections) + "\n", drawn)


def _sides(records: Sequence[Record]) -> list[list[Cost]]:
    sides = []
    for together in (False, True):
        mine = [one for one in records if bool(overlaps(one)) == together]
        known = [cost(mine, label) for label in labels(mine)]
        sides.append([one for one in known if one is not None])
    return sides


def _opening(run: Run, records: Sequence[Record], concave: Sequence[Record]) -> str:
    boxes, proof = step(records, "aabb", HULL), step(concave, HULL, EXACT)
    lines = [
        "# What accuracy costs in time",
        f"Every rung of the ladder checked the same {len(records)} pairs of meshes, and each "
        f"answer was compared with the known and proven truth. {run.about}".strip(),
        "Errors are in percent of the size of the smaller body:",
        "\n".join(
            [
                f"- **From boxes to hulls** takes {_longer(boxes)} the time: {_gain(boxes)}. "
                f"Boxes and hulls together settle {counted(len(records) - len(concave), 'pair')}.",
                f"- **From hulls to the proof on triangles** takes {_longer(proof)} the time on "
                f"the other {len(concave)}: {_gain(proof)}.",
                *_of_parts(concave),
            ]
        ),
        "Compare ratios, not absolute times: other work ran on the machine. An error is the "
        "difference between the signed distance of a rung (a gap, or minus the depth) and the "
        "nearest value of the proven interval. The size of a body is the diagonal of its box.",
    ]
    return "\n\n".join(lines)


def _longer(one: Step) -> str:
    return words.NONE if one.longer is None else words.times_as_long(one.longer.median)


def _gain(one: Step) -> str:
    before, after = (words.NONE if e is None else words.percent(e) for e in (one.before, one.after))
    wrong = f"wrong verdicts from {one.wrong_before} to {one.wrong_after}"
    return f"the median error goes from {before} to {after}, {wrong}"


def _of_parts(concave: Sequence[Record]) -> list[str]:
    """The coarsest and the finest that were made, against the proof on the same pairs."""
    known = [step(concave, EXACT, one) for one in labels(concave) if one.startswith(PARTS)]
    made = [one for one in known if one.pairs]
    if not made:
        return []
    said = [
        f"{_longer(one)} at a threshold of {one.end.removeprefix(PARTS).strip()} ("
        f"{counted(one.pairs, 'pair')}, {one.wrong_after} wrong, median error "
        f"{words.NONE if one.after is None else words.percent(one.after)})"
        for one in dict.fromkeys((made[0], made[-1]))
    ]
    return [
        "- **Convex parts**, built without a cache, take a multiple of the time of the proof on "
        f"the same pairs: {', '.join(said)}."
    ]


def _making(run: Run, records: Sequence[Record], found: dict[str, RungSummary]) -> str:
    effort, made = run.header["effort"], run.header["environment"]
    versions = ", ".join(f"{name} {version}" for name, version in made["versions"].items())
    failed = [one for one in run.records if "pair" not in one]
    spent = sum(one["seconds"] for one in run.records)
    steady = [one.steadiness.median for one in found.values() if one.steadiness is not None]
    spans = f"{min(steady):.1f} to {max(steady):.1f}" if steady else "no rung was repeated"
    lines = [
        "## How this was made",
        f"```\n{run.command}\n```",
        f"On {made['date']}, in {spent / 60:.0f} minutes, with {versions}. Machine: "
        f"{made['machine']}.",
        f"Corpus: {'; '.join(run.corpora)}. Each pair has a process of its own, in which the rungs "
        f"take turns, up to {effort['repeat']} rounds; for each pair the median counts. The "
        "slowest round over the fastest, as a median of the pairs, by rung: "
        f"{spans}.",
        f"Budget, wall time: {effort['rung_seconds']:g} s for all runs of a rung on a pair, "
        f"{effort['pair_seconds']:g} s for all rungs of a pair. Pairs of more than "
        f"{effort['part_triangles']:,} triangles together are not split into convex parts. So the "
        "figures of convex parts are those of the smaller meshes, which favours them.",
    ]
    if failed:
        why = "; ".join(f"{one['case']['id']}: {one['failure']}" for one in failed)
        lines.append(f"Pairs that could not be measured: {len(failed)} ({why}).")
    else:
        lines.append(f"All {len(records)} pairs could be measured.")
    return "\n\n".join(lines)
