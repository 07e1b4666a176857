"""The sections of the page that hold figures and tables."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from bench.accuracy import words
from bench.accuracy.figure_bars import WORDS
from bench.accuracy.reasons import reasons
from bench.accuracy.rungs import EXACT, PARTS, RungSummary, depth_widths, labels, step
from bench.accuracy.spread import Spread
from bench.accuracy.stages import (
    GROUPS,
    OTHER,
    StageTimes,
    process,
    settled_by,
    stage_times,
)
from bench.accuracy.verdicts import OUTCOMES, agreement
from bench.drawing import embedded
from satcheck.cli.report.numbers import mebibytes
from satcheck.cli.report.words import counted

Record = dict[str, Any]
HULL = "hull"
SOUND = ("aabb", "obb", HULL)


def next_factor(folder: str, records: Sequence[Record], concave: Sequence[Record]) -> str:
    known = labels(concave)
    parts = [label for label in known if label.startswith(PARTS)]
    ladder = [label for label in known if label in (*SOUND, EXACT)]
    stairs = [*pairwise(ladder)]
    stairs += [*pairwise([HULL, *parts])] + [(one, EXACT) for one in parts[-1:]]
    rows = []
    for start, end in stairs:
        one = step(records if end in SOUND else concave, start, end)
        errors = [words.NONE if e is None else words.percent(e) for e in (one.before, one.after)]
        rows.append(
            [
                f"{start} → {end}",
                str(one.pairs),
                words.factors(one.longer),
                " → ".join(errors),
                f"{one.wrong_before} → {one.wrong_after}",
            ]
        )
    head = ["step", "pairs", "CPU time, median (quartiles)", "median error", "wrong verdicts"]
    return "\n\n".join(
        [
            "## What the next factor of accuracy costs",
            embedded(folder, "ladder", "Error against time, rung by rung"),
            f"The {len(concave)} pairs that boxes and hulls leave open. Across: CPU time on a "
            "pair, everything built from nothing, over that of the exact rung on the same pair (1 "
            "x is the proof; cached parts: wall time). Up: median error. Both with quartiles; in "
            "brackets the number of pairs: convex parts count where there was time to make them, "
            "and of bodies with an inside.",
            "Step by step, each over the pairs that both rungs answered: up to hulls of all pairs, "
            "beyond them of those that they leave open.",
            words.table(head, rows),
            "Of overlapping bodies convex parts bound the depth from below; the figure they give "
            "is that of the hulls, and so is its error.",
        ]
    )


def of_rungs(folder: str, found: dict[str, RungSummary]) -> str:
    rows = []
    for rung in found.values():
        memory = words.NONE if rung.megabytes is None else mebibytes(rung.megabytes.median)
        cached = words.NONE if rung.cached is None else words.time(rung.cached.median)
        cpu = words.NONE if rung.cpu is None else words.time(rung.cpu.median)
        room = words.NONE if rung.excess is None else words.percent(rung.excess.median)
        rows.append(
            [rung.label, str(rung.pairs), *words.times(rung.cold), cpu, cached, memory, room]
        )
    head = ["rung", "pairs", "median", "quartiles", "worst", "CPU", "cached", "memory"]
    head.append("volume error")
    errors = [
        [
            rung.label,
            *words.shares(rung.errors.apart),
            _exactly(rung.errors.exact_apart, rung.errors.apart),
            *words.shares(rung.errors.overlapping),
            _exactly(rung.errors.exact_overlapping, rung.errors.overlapping),
        ]
        for rung in found.values()
        if rung.errors.apart or rung.errors.overlapping
    ]
    columns = ("median", "3/4 within", "worst", "right")
    of_errors = ["rung", *(f"{side}: {what}" for side in ("apart", "overlap") for what in columns)]
    return "\n\n".join(
        [
            "## Cost and error of each rung, over all pairs",
            embedded(folder, "rungs", "Time and error of every pair, rung by rung"),
            "Wall time, cold: from meshes in memory to the answer, with hulls, trees and parts "
            "built from nothing; of the Boolean with the start of its child process. Cached: parts "
            "read from disk, the child process running. CPU: median of the cold runs, children "
            "included. Memory: of the child process, or by how much the process grows that asks, "
            "whichever is more; median. Volume error: of what stands for a body, without its "
            "sign; median of the bodies that have a volume. Convex parts count where they were "
            "made.",
            words.table(head, rows),
            "Errors, in sizes of the smaller body (right: how many are 0 within rounding); the "
            "Boolean gives no distance:",
            words.table(of_errors, errors),
        ]
    )


def _exactly(count: int, one: Spread | None) -> str:
    return words.NONE if one is None else f"{count} of {one.count}"


def of_verdicts(folder: str, found: dict[str, RungSummary]) -> str:
    rows = [
        [
            rung.label,
            *(str(rung.outcomes[kind]) for kind in OUTCOMES),
            str(rung.false_proofs),
        ]
        for rung in found.values()
    ]
    head = ["rung", *(WORDS[kind] for kind in OUTCOMES), "of them proven, wrong"]
    sound = [found[label] for label in SOUND if label in found]
    misses, judged = sum(one.outcomes["miss"] for one in sound), sum(one.judged for one in sound)
    proofs = sum(rung.false_proofs for rung in found.values())
    return "\n\n".join(
        [
            "## Yes or no",
            embedded(folder, "verdicts", "Right and wrong verdicts, rung by rung"),
            "A false hit is a reported overlap of bodies that do not overlap, a miss the contrary. "
            f"Boxes and hulls may only err towards an overlap: "
            f"{counted(misses, 'miss', 'misses')} in {judged} verdicts. "
            "Convex parts may err either way, and call possible what they cannot prove. "
            f"Verdicts that a rung called proven and that are wrong: {proofs}.",
            words.table(head, rows),
        ]
    )


def of_the_default(folder: str, records: Sequence[Record]) -> str:
    settled = settled_by(records)
    order = [label for label in (*SOUND, EXACT) if label in settled]
    order += [label for label in settled if label not in order]
    said = ", ".join(f"{label} {settled[label]}" for label in order)
    wall, cpu, memory = (process(records, what) for what in ("wall", "cpu", "megabytes"))
    lines = [
        "## What the default does",
        "A plain check climbs until a rung proves its answer. How many pairs each rung settled: "
        f"{said} (of {sum(settled.values())}; `exact`: triangles).",
        embedded(folder, "stages", "Where the time of a plain check goes"),
        "Mean share of each stage in the time of a pair, in a process that runs already. Placing: "
        "bodies into the world, and what a report says of them; triangles: with the tree of boxes "
        "over them, containment and the touch band; depth search: with the first way out, which "
        "the hulls give.",
        _stages(stage_times(records)),
    ]
    if wall and cpu and memory:
        lines.append(
            "The command as it is typed takes a median of "
            f"{words.time(cpu.median)} of CPU time (quartiles {words.time(cpu.first)} .. "
            f"{words.time(cpu.third)}, most {words.time(cpu.high)}; wall time "
            f"{words.time(wall.median)}), most of it the start of Python, and "
            f"{memory.median:.0f} MiB (most {memory.high:.0f} MiB)."
        )
    return "\n\n".join(lines)


def _stages(kinds: Sequence[StageTimes]) -> str:
    groups = [name for name in (*GROUPS, OTHER) if any(name in kind.shares for kind in kinds)]
    rows = [
        [
            kind.kind,
            str(kind.pairs),
            *words.times(kind.total),
            *(words.percent(kind.shares.get(group, 0.0)) for group in groups),
        ]
        for kind in kinds
    ]
    return words.table(["", "pairs", "median", "quartiles", "worst", *groups], rows)


def of_silence(records: Sequence[Record]) -> str:
    found = reasons(records)
    rows = [
        [state, why, ", ".join(f"{label}: {count}" for label, count in counts.items())]
        for (state, why), counts in found.items()
    ]
    lines = ["## What gave no answer"]
    if rows:
        lines.append(words.table(["", "why", "on how many pairs"], rows))
    else:
        lines.append("Every rung has answered on every pair.")
    return "\n\n".join(lines)


def of_the_truth(records: Sequence[Record]) -> str:
    seen, widths = agreement(records), depth_widths(records)
    unknown = Counter(one["pair"]["truth"]["relation"] is None for one in records)[True]
    lines = [
        "## What it is held against",
        "Verdicts: what the corpus states, found by other libraries and methods or by hand; where "
        "it says nothing, what the exact rung has proven. Distances and depths: the proven bounds "
        "of the exact rung.",
        "Where the corpus states something, the exact rung was held against it: "
        f"{seen.wrong_verdicts} of {seen.verdicts} verdicts differ, "
        f"{seen.wrong_way_outs} of {seen.way_outs} depths have a lower bound above a way out "
        f"that is known to work, {seen.wrong_distances} of {seen.distances} gaps lie outside the "
        "proven bounds (by more than 1e-9 of the size). Pairs of which nothing is proven: "
        f"{unknown}.",
    ]
    if widths is not None:
        lines.append(
            "The error of the exact rung is 0 by definition: what it leaves open is the width of "
            f"its interval. Of the {widths.count} depths that is a median of "
            f"{words.percent(widths.median)} of the depth, three quarters are within "
            f"{words.percent(widths.third)}, the widest is {words.percent(widths.high)}."
        )
    return "\n\n".join(lines)
