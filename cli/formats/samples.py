"""A report over many poses as text: a row for each pose that fails, or for each pair of many
poses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.messages import nothing_checked
from satcheck.audit.words import counted, in_motion, interval, with_unit
from satcheck.cli.formats.summary import config_line
from satcheck.cli.formats.tables import (
    ROWS,
    VERDICT_STYLES,
    Column,
    fitted_each,
    hidden,
    joined,
    table,
)
from satcheck.cli.output import issue_line
from satcheck.report.assets import ASSET_VERDICTS
from satcheck.report.report import OVERLAPS
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from satcheck.cli.output import Page
    from satcheck.report.report import Finding, Verdict
    from satcheck.report.samples import SampledPair, SampledPose, SamplesReport

# More poses than this, and pairs are listed instead of poses.
FEW_POSES = 20
# Of one pose at most so many pairs that were found.
FOUND = 8
# At most so many lines about single poses.
REMARKS = 10
# What one pose does, and what several do.
_VERDICTS: dict[Verdict, tuple[str, str]] = {
    "pass": ("passes", "pass"),
    "fail": ("fails", "fail"),
    "incomplete": ("is incomplete", "are incomplete"),
}


def render(result: SamplesReport, page: Page, *, top: int | None = None) -> str:
    """The whole text, final newline included. Errors are not in it: they go to stderr.

    top: how many poses or pairs at most, the worst first; all count in the summary.
    """
    lines: list[str] = []
    if result.summary.samples <= FEW_POSES:
        found = [sample for sample in result.samples if sample.verdict != "pass"]
        found.sort(key=lambda sample: ASSET_VERDICTS.index(sample.verdict))
        poses = found[: top or ROWS]
        lines += _poses(poses, unit_of(result.units), page) if poses else []
        said = hidden(len(found) - len(poses), "pose")
    else:
        met = sorted(
            (pair for pair in result.pairs if not pair.settled),
            key=lambda pair: (-pair.overlaps, -pair.undecided, -pair.near, -pair.touches),
        )
        rows = met[: top or ROWS]
        lines += _pairs(rows, result.summary.samples, page) if rows else []
        said = hidden(len(met) - len(rows), "pair")
    said += [issue_line(issue) for issue in result.issues if issue.severity != "error"]
    said += _remarks(result.samples)
    if result.config is not None:
        said.append(config_line(result.config))
    return joined([*lines, *fitted_each([*said, *closing(result)], page)], page)


def closing(result: SamplesReport, *, written: bool = False) -> list[str]:
    """Return the last lines: what was counted, the verdict, and what to do next. written: the
    report goes to a file."""
    lines = [samples_counts(result), samples_verdict(result)]
    if result.summary.verdict == "fail" and not written:
        shown = "the poses in 3-D" if result.truncated is None else those_listed(result)
        deepest = "" if result.settings.depth else "; --depth finds the deepest of each pair"
        lines.append(f"Next: -o report.html shows {shown}{deepest}.")
    return lines


def _poses(samples: Sequence[SampledPose], unit: str | None, page: Page) -> list[str]:
    columns = (
        Column("pose", tuple(str(sample.number) for sample in samples), right=True),
        Column("verdict", tuple(sample.verdict for sample in samples), graded=True),
        Column("found", tuple("\n".join(_found(s.findings, unit)) for s in samples), folds=True),
    )
    return table(columns, page, [VERDICT_STYLES[sample.verdict] for sample in samples])


def _found(findings: Sequence[Finding], unit: str | None) -> list[str]:
    """`base and left penetrating 0.25`, one a line, and how many more are left open."""
    wrong = [finding for finding in findings if finding.severity == "error"]
    lines = [_line(each, unit) for each in wrong[:FOUND]]
    if len(wrong) > FOUND:
        lines.append(f"{counted(len(wrong) - FOUND, 'more pair')}")
    if undecided := sum(finding.severity == "warning" for finding in findings):
        lines.append(f"{counted(undecided, 'pair')} undecided")
    return lines


def _line(finding: Finding, unit: str | None) -> str:
    if finding.at_rest == "separated" and finding.motion is not None:
        return f"{finding.a} {in_motion(finding, unit, f' {finding.b}')}"
    known = finding.relation in OVERLAPS and finding.depth is not None
    depth = f" {with_unit(interval(finding.depth_bounds), unit)}" if known else ""
    return f"{finding.a} and {finding.b} {finding.relation}{depth}"


def _pairs(pairs: Sequence[SampledPair], samples: int, page: Page) -> list[str]:
    columns = [
        Column("A", tuple(pair.a for pair in pairs), named=True),
        Column("B", tuple(pair.b for pair in pairs), named=True),
    ]
    for name in ("overlaps", "touches", "near", "undecided"):
        cells = tuple(_share(getattr(pair, name), samples) for pair in pairs)
        columns += [Column(name, cells, right=True)] if any(cells) else []
    first = tuple("" if p.first_overlap is None else f"pose {p.first_overlap:,}" for p in pairs)
    columns += [Column("first overlap", first, right=True)] if any(first) else []
    return table(columns, page)


def _share(count: int, total: int) -> str:
    """`24 (8 %)`; nothing for none, and neither 0 % nor 100 % for what is not."""
    if not count:
        return ""
    percent = round(100 * count / total)
    if percent == 0 or (percent == 100 and count < total):
        return f"{count:,} ({'< 1' if percent == 0 else '> 99'} %)"
    return f"{count:,} ({percent} %)"


def _remarks(samples: Sequence[SampledPose]) -> list[str]:
    lines = [
        f"pose {sample.number}: {issue_line(issue)}"
        for sample in samples
        for issue in sample.issues
    ]
    if len(lines) > REMARKS:
        return [*lines[:REMARKS], f"{counted(len(lines) - REMARKS, 'more remark')}: JSON has all"]
    return lines


def samples_counts(result: SamplesReport) -> str:
    """`300 random poses (seed 0), 7 bodies, 12 pairs: 190 pass, 110 fail.`"""
    kind = "pose" if result.seed is None else "random pose"
    seed = "" if result.seed is None else f" (seed {result.seed})"
    parts = [
        counted(count, *words)
        for verdict, words in _VERDICTS.items()
        if (count := result.summary.by_verdict[verdict])
    ]
    return (
        f"{counted(result.summary.samples, kind)}{seed}, "
        f"{counted(len(result.bodies), 'body', 'bodies')}, "
        f"{counted(result.summary.pairs.total, 'pair')}"
        f"{f', {result.summary.pairs.allowed:,} allowed' if result.summary.pairs.allowed else ''}"
        f"{f', {result.summary.pairs.exempt:,} more exempt' if result.summary.pairs.exempt else ''}"
        f": {', '.join(parts)}."
    )


def those_listed(result: SamplesReport) -> str:
    """`20 poses of 20`, `the first 100 poses with a finding, of 3,000`"""
    listed = counted(len(result.samples), "pose")
    if result.truncated is not None:
        listed = f"the first {listed} with a finding,"
    return f"{listed} of {result.summary.samples:,}"


def samples_verdict(result: SamplesReport) -> str:
    """`FAIL: 9 of 12 pairs fail; most often base and upper, in 24 poses.`"""
    word = result.summary.verdict.upper()
    if any(issue.severity == "error" for issue in result.issues):
        word = "ERROR"
    if result.summary.verdict == "fail":
        return f"{word}: {_failed(result)}."
    if result.summary.verdict == "pass":
        return f"{word}: no collision in any pose."
    unchecked = nothing_checked(result.issues)
    return " ".join([f"{word}:", *(unchecked or ["no collision was found, but not proven."])])


def _failed(result: SamplesReport) -> str:
    failed = [pair for pair in result.pairs if pair.fails]
    if not failed:  # bodies that rules ask to stand
        poses = counted(result.summary.by_verdict["fail"], "pose fails", "poses fail")
        return f"{poses} by the support of bodies"
    worst = min(failed, key=lambda pair: (-pair.fails, pair.first_overlap or 0))
    often = f"{worst.a} and {worst.b}, in {counted(worst.fails, 'pose')}"
    if len(failed) == 1:
        return f"1 pair fails: {often}"
    total = counted(result.summary.pairs.total, "pair")
    return f"{len(failed):,} of {total} fail; most often {often}"
