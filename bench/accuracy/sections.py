"""The sections of the page that hold figures and tables."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from bench.accuracy import words
from bench.accuracy.reasons import reasons
from bench.accuracy.rungs import EXACT, PARTS, RungSummary, depth_widths, labels, step
from bench.accuracy.stages import process, settled_by, stage_times
from bench.accuracy.verdicts import agreement
from bench.drawing import embedded
from satcheck.audit.words import counted

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
                words.NONE if one.longer is None else words.factor(one.longer.median),
                " → ".join(errors),
                f"{one.wrong_before} → {one.wrong_after}",
            ]
        )
    head = ["step", "pairs", "CPU time", "median error", "wrong verdicts"]
    return "\n\n".join(
        [
            "## What the next factor of accuracy costs",
            embedded(folder, "ladder", "Error against time, rung by rung"),
            f"The plot shows the {len(concave)} pairs that boxes and hulls leave open. The time of "
            "a rung is CPU time without a cache (for cached parts: wall time), divided by that of "
            "the exact rung on the same pair. Bars show quartiles, brackets the number of pairs.",
            "The table compares neighbouring rungs on the pairs that both answered, by medians: "
            "up to hulls on all pairs, after them on those that boxes and hulls leave open. Convex "
            "parts count only for bodies with an inside, and only if there was time to build them.",
            words.table(head, rows),
            "For overlapping bodies convex parts prove only a lower bound of the depth. The tables "
            "therefore count the depth of the hulls for them.",
        ]
    )


def of_rungs(folder: str, found: dict[str, RungSummary]) -> str:
    rows = []
    for rung in found.values():
        cached = words.NONE if rung.cached is None else words.time(rung.cached.median)
        errors = [*words.shares(rung.errors.apart), *words.shares(rung.errors.overlapping)]
        rows.append([rung.label, str(rung.pairs), *words.times(rung.cold), cached, *errors])
    head = ["rung", "pairs", "time", "worst", "cached"]
    head += ["error apart", "worst", "overlapping", "worst"]
    return "\n\n".join(
        [
            "## Cost and error of each rung, over all pairs",
            embedded(folder, "rungs", "Time and error of every pair, rung by rung"),
            "All figures are medians, unless they are the worst. The wall time is cold: from "
            "meshes in memory to the answer, with building hulls, trees and parts, and with the "
            "start of the child process in which manifold3d computes the common volume. Cached: "
            "parts are on disk, and the child process runs. The Boolean gives no distance.",
            words.table(head, rows),
        ]
    )


def of_verdicts(folder: str, found: dict[str, RungSummary]) -> str:
    sound = [found[label] for label in SOUND if label in found]
    misses, judged = sum(one.outcomes["miss"] for one in sound), sum(one.judged for one in sound)
    proofs = sum(rung.false_proofs for rung in found.values())
    return "\n\n".join(
        [
            "## Yes or no",
            embedded(folder, "verdicts", "Right and wrong verdicts, rung by rung"),
            "A false hit is a reported overlap of bodies that do not overlap, a miss is the "
            "opposite. "
            f"Boxes and hulls may only report false hits: "
            f"{counted(misses, 'miss', 'misses')} in {judged} verdicts. "
            "Convex parts may err either way, and call an unproven verdict possible. "
            f"Verdicts that a rung called proven and that are wrong: {proofs}.",
        ]
    )


def of_the_default(folder: str, records: Sequence[Record]) -> str:
    settled, kinds = settled_by(records), stage_times(records)
    order = [label for label in (*SOUND, EXACT) if label in settled]
    order += [label for label in settled if label not in order]
    said = ", ".join(f"{label} {settled[label]}" for label in order)
    wall, cpu, memory = (process(records, what) for what in ("wall", "cpu", "megabytes"))
    lines = [
        "## What the default does",
        "A check climbs the ladder until a rung proves the answer, without convex parts. Each rung "
        "decided this many pairs: "
        f"{said} (of {sum(settled.values())}; `exact`: triangles).",
        embedded(folder, "stages", "Where the time of a plain check goes"),
        "The plot shows the mean share of each stage in the time of a pair, in a running process. "
        "Placing includes the entries of the bodies in the report. Triangles include the tree of "
        "boxes, containment and the touch band. The depth search includes the first way out, which "
        "comes from the hulls.",
        words.table(
            ["", "pairs", "median", "worst"],
            [[kind.kind, str(kind.pairs), *words.times(kind.total)] for kind in kinds],
        ),
    ]
    if wall and cpu and memory:
        lines.append(
            "The whole command takes a median of "
            f"{words.time(cpu.median)} of CPU time (most {words.time(cpu.high)}; wall time "
            f"{words.time(wall.median)}), most of it the start of Python, and "
            f"{memory.median:.0f} MiB (most {memory.high:.0f} MiB)."
        )
    return "\n\n".join(lines)


def of_silence(records: Sequence[Record]) -> str:
    told = [f"- {state}: {why} ({count})" for (state, why), count in reasons(records).items()]
    return "\n\n".join(
        ["## What gave no answer", "\n".join(told) or "Every rung has answered on every pair."]
    )


def of_the_truth(records: Sequence[Record]) -> str:
    seen, widths = agreement(records), depth_widths(records)
    unknown = Counter(one["pair"]["truth"]["relation"] is None for one in records)[True]
    lines = [
        "## What the answers are compared with",
        "Verdicts are compared with the statements of the corpus, which come from other libraries "
        "and methods or from hand; without a statement with the proof of the exact rung. Distances "
        "and depths are compared with the proven bounds of the exact rung.",
        "The exact rung against the statements of the corpus: "
        f"{seen.wrong_verdicts} of {seen.verdicts} verdicts differ, "
        f"{seen.wrong_way_outs} of {seen.way_outs} depths have a lower bound above a way out "
        f"that is known to work, {seen.wrong_distances} of {seen.distances} gaps lie outside the "
        "proven bounds (by more than 1e-9 of the size). Pairs without any proof: "
        f"{unknown}.",
    ]
    if widths is not None:
        lines.append(
            "The error of the exact rung is 0 by definition; only its interval has a width: of "
            f"the {widths.count} depths {words.percent(widths.median)} of the depth as a median, "
            f"at most {words.percent(widths.third)} for three quarters of them, and "
            f"{words.percent(widths.high)} for the widest."
        )
    return "\n\n".join(lines)
