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
from satcheck.cli.formats.numbers import mebibytes
from satcheck.cli.formats.words import counted

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
            f"The {len(concave)} pairs that boxes and hulls do not decide are shown. The "
            "horizontal axis is the CPU time on a pair, without a cache, divided by that of the "
            "exact rung on the same pair (for cached parts: wall time). The vertical axis is the "
            "median error. Bars show quartiles, and brackets the number of pairs. Convex parts "
            "count only for bodies with an inside, and only if there was time to build them.",
            "The table compares neighbouring rungs on the pairs that both answered. The steps up "
            "to hulls include all pairs, the steps after them only the pairs that boxes and hulls "
            "do not decide.",
            words.table(head, rows),
            "For overlapping bodies convex parts prove only a lower bound of the depth. The table "
            "therefore counts the depth of the hulls for them, with the error of the hulls.",
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
            "Wall time is cold: from meshes in memory to the answer, with the time to build "
            "hulls, trees and parts, and to start the child process in which manifold3d computes "
            "the common volume of both bodies. Cached: parts are read from disk, and the child "
            "process runs already. CPU: median of the cold runs, with child processes. Memory: "
            "the median of the child process, or of the growth of the calling process if that is "
            "larger. Volume error: the absolute error of the shapes that replace a body; median "
            "of the bodies with a volume. Convex parts count only if they were built.",
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
            "A false hit is a reported overlap of bodies that do not overlap, a miss is the "
            "opposite. "
            f"Boxes and hulls may only err towards an overlap: "
            f"{counted(misses, 'miss', 'misses')} in {judged} verdicts. "
            "Convex parts may err either way, and call an unproven verdict possible. "
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
        "A check climbs the ladder until a rung proves the answer. Each rung decided this many "
        "pairs: "
        f"{said} (of {sum(settled.values())}; `exact`: triangles).",
        embedded(folder, "stages", "Where the time of a plain check goes"),
        "The plot and the table show the mean share of each stage in the time of a pair, in a "
        "running process. Placing includes the entries of the bodies in the report. Triangles "
        "include the tree of boxes, containment and the touch band. The depth search includes the "
        "first way out, which comes from the hulls.",
        _stages(stage_times(records)),
    ]
    if wall and cpu and memory:
        lines.append(
            "The whole command takes a median of "
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
        "## What the answers are compared with",
        "Verdicts are compared with the statements of the corpus, which come from other libraries "
        "and methods or from hand. If it states nothing, they are compared with the proof of the "
        "exact rung. Distances and depths are compared "
        "with the proven bounds of the exact rung.",
        "The exact rung itself was compared with the statements of the corpus: "
        f"{seen.wrong_verdicts} of {seen.verdicts} verdicts differ, "
        f"{seen.wrong_way_outs} of {seen.way_outs} depths have a lower bound above a way out "
        f"that is known to work, {seen.wrong_distances} of {seen.distances} gaps lie outside the "
        "proven bounds (by more than 1e-9 of the size). Pairs without any proof: "
        f"{unknown}.",
    ]
    if widths is not None:
        lines.append(
            "The error of the exact rung is 0 by definition; only its interval has a width. "
            f"Of the {widths.count} depths the median width is "
            f"{words.percent(widths.median)} of the depth, three quarters are at most "
            f"{words.percent(widths.third)} wide, and the widest is "
            f"{words.percent(widths.high)} wide."
        )
    return "\n\n".join(lines)
