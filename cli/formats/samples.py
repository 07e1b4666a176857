"""A report over many poses as text: a row for each pose, or for each pair of many poses."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from rich import box
from rich.table import Table
from rich.text import Text

from satcheck.cli.formats.canvas import Canvas
from satcheck.cli.formats.config import config_line
from satcheck.cli.formats.samples_summary import samples_counts, samples_verdict
from satcheck.cli.formats.words import counted, in_motion, interval, issue_line, with_unit
from satcheck.report.report import OVERLAPS
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from satcheck.audit.sampled import PairTally, Samples
    from satcheck.cli.output import Page
    from satcheck.report.report import Finding
    from satcheck.report.samples import SampledPose

# More poses than this, and pairs are listed instead of poses.
FEW_POSES = 20
# Of the pairs at most so many, the worst first.
ROWS = 60
# Of one pose at most so many pairs that were found.
FOUND = 8
# At most so many lines about single poses.
REMARKS = 10
# The worst first. Colour only repeats what the word says.
_COLOURS = {"fail": "bold red", "incomplete": "bold magenta", "pass": "green"}


def render(result: Samples, page: Page, *, top: int | None = None) -> str:
    """The whole text, final newline included. Errors are not in it: they go to stderr.

    top: how many poses or pairs at most, the worst first; all count in the summary.
    """
    console = Canvas(page)
    if result.number <= FEW_POSES:
        poses = result.samples if top is None else _worst(result.samples)[:top]
        console.print(_poses(poses, unit_of(result.units), unicode=page.unicode))
        if more := len(result.samples) - len(poses):
            console.print(f"{counted(more, 'more pose')} not shown (--top {top})")
    else:
        met = sorted(
            (pair for pair in result.pairs if not pair.settled),
            key=lambda pair: (-pair.overlaps, -pair.undecided, -pair.near, -pair.touches),
        )
        rows = met[: top or ROWS]
        if rows:
            console.print(_pairs(rows, result.number, unicode=page.unicode))
        if more := len(met) - len(rows):
            why = f"not shown (--top {top})" if top else "not shown: JSON has all"
            console.print(f"{counted(more, 'more pair')} {why}")
    for issue in result.issues:
        if issue.severity != "error":
            console.print(issue_line(issue))
    for line in _remarks(result.samples):
        console.print(line)
    if result.config is not None:
        console.print(config_line(result.config))
    console.print(samples_counts(result))
    console.print(samples_verdict(result))
    return console.text()


def _worst(samples: Sequence[SampledPose]) -> list[SampledPose]:
    return sorted(samples, key=lambda sample: list(_COLOURS).index(sample.verdict))


def _poses(samples: Sequence[SampledPose], unit: str | None, *, unicode: bool) -> Table:
    table = Table(header_style="bold", box=box.ROUNDED if unicode else box.ASCII)
    table.add_column("#", justify="right", no_wrap=True)
    table.add_column("pose", overflow="fold")
    table.add_column("verdict", no_wrap=True)
    table.add_column("found", overflow="fold")
    for sample in samples:
        table.add_row(
            str(sample.number),
            _as_text(sample.pose),
            Text(sample.verdict, style=_COLOURS[sample.verdict]),
            "\n".join(_found(sample.findings, unit)),
        )
    return table


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
    pair = f"{finding.a} and {finding.b}"
    if finding.at_rest == "separated" and finding.motion is not None:
        return f"{pair}, while they move: {in_motion(finding, unit)}"
    return f"{pair} {finding.relation}{_depth(finding, unit)}"


def _depth(finding: Finding, unit: str | None) -> str:
    known = finding.relation in OVERLAPS and finding.depth is not None
    return f" {with_unit(interval(finding.depth_bounds), unit)}" if known else ""


def _pairs(pairs: Sequence[PairTally], samples: int, *, unicode: bool) -> Table:
    table = Table(header_style="bold", box=box.ROUNDED if unicode else box.ASCII)
    table.add_column("A", overflow="fold")
    table.add_column("B", overflow="fold")
    counts = ("overlaps", "touches", "near", "undecided")
    shown = [name for name in counts if any(getattr(pair, name) for pair in pairs)]
    for name in shown:
        table.add_column(name, justify="right", no_wrap=True)
    if "overlaps" in shown:
        table.add_column("the first overlap", overflow="fold")
    for pair in pairs:
        first = pair.first_pose
        table.add_row(
            pair.a,
            pair.b,
            *(_share(getattr(pair, name), samples) for name in shown),
            *([] if first is None else [_as_text(first)]),
        )
    return table


def _share(count: int, total: int) -> str:
    """`24 (8 %)`; nothing for none, and neither 0 % nor 100 % for what is not."""
    if not count:
        return ""
    percent = round(100 * count / total)
    if percent == 0 or (percent == 100 and count < total):
        return f"{count:,} ({'< 1' if percent == 0 else '> 99'} %)"
    return f"{count:,} ({percent} %)"


def _as_text(pose: Mapping[str, float | list[float]]) -> str:
    """As --pose takes it."""
    return json.dumps(pose, ensure_ascii=False)


def _remarks(samples: Sequence[SampledPose]) -> list[str]:
    lines = [
        f"pose {sample.number}: {issue_line(issue)}"
        for sample in samples
        for issue in sample.issues
    ]
    if len(lines) > REMARKS:
        return [*lines[:REMARKS], f"{counted(len(lines) - REMARKS, 'more remark')}: JSON has all"]
    return lines
