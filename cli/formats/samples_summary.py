"""The last lines of a report over many poses: its counts, then PASS, FAIL, INCOMPLETE or ERROR."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.cli.formats.summary import doubts, nothing_checked
from satcheck.cli.formats.words import counted

if TYPE_CHECKING:
    from satcheck.audit.sampled import Samples

# Failing pairs that are named, the most frequent first.
NAMED = 3


def samples_counts(result: Samples) -> str:
    """`300 random poses (seed 0), 7 bodies, 12 pairs: 190 pass, 110 fail.`"""
    kind = "pose" if result.seed is None else "random pose"
    seed = "" if result.seed is None else f" (seed {result.seed})"
    singular = {"pass": "passes", "fail": "fails", "incomplete": "is incomplete"}
    plural = {"pass": "pass", "fail": "fail", "incomplete": "are incomplete"}
    parts = [
        f"{count:,} {singular[verdict] if count == 1 else plural[verdict]}"
        for verdict in ("pass", "fail", "incomplete")
        if (count := result.by_verdict[verdict])
    ]
    line = (
        f"{counted(result.number, kind)}{seed}, "
        f"{counted(len(result.bodies), 'body', 'bodies')}, "
        f"{counted(result.counts.total, 'pair')}"
        f"{f', {result.counts.allowed:,} allowed' if result.counts.allowed else ''}"
        f"{f', {result.counts.exempt:,} more exempt' if result.counts.exempt else ''}"
        f": {', '.join(parts)}."
    )
    return " ".join([line, *doubts(result.issues)])


def samples_verdict(result: Samples) -> str:
    """`FAIL: 9 pairs fail: base and upper in 24 poses, base and left in 14 poses, and 7 more.`"""
    if result.verdict == "pass":
        return "PASS: no collision in any pose."
    if result.verdict == "fail":
        return f"FAIL: {_failed(result)}. Next: --pose POSE -o report.html shows one pose in 3-D."
    unchecked = nothing_checked(result.issues)
    failed = any(issue.severity == "error" for issue in result.issues)
    word = "ERROR" if failed else "INCOMPLETE"
    return " ".join([f"{word}:", *(unchecked or ["no collision was found, but not proven."])])


def _failed(result: Samples) -> str:
    failed = [pair for pair in result.pairs if pair.fails]
    if not failed:  # bodies that rules ask to stand
        poses = result.by_verdict["fail"]
        verb = "fails" if poses == 1 else "fail"
        return f"{counted(poses, 'pose')} {verb} by the support of bodies"
    failed.sort(key=lambda pair: (-pair.fails, pair.first_overlap or 0))
    named = [f"{p.a} and {p.b} in {counted(p.fails, 'pose')}" for p in failed[:NAMED]]
    more = f", and {len(failed) - len(named):,} more" if len(failed) > len(named) else ""
    verb = "fails" if len(failed) == 1 else "fail"
    return f"{counted(len(failed), 'pair')} {verb}: {', '.join(named)}{more}"
