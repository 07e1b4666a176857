"""Suggested permissions, ready to be pasted: rules in TOML, or lines of an SRDF."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from satcheck.audit.words import counted, number, with_unit
from satcheck.report.json import escaped
from satcheck.report.report import OVERLAPS
from satcheck.scene.rules import Selector
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.audit.suggest import Suggestions
    from satcheck.report.suggestions import Suggestion, SuggestionsReport, Unchecked, Why

RULES_ALONE = """\
# Give this file beside the scene, or move its rules into the scene.
schema = "satcheck.scene/1"
bodies = []
"""
# Of pairs that are not decided at most so many are named.
_NAMED = 5
# As the MoveIt setup assistant calls them.
_SRDF_REASONS: dict[Why, str] = {
    "adjacent": "Adjacent",
    "always": "Always",
    "contact": "Default",
    "never": "Never",
}


def chosen(report: SuggestionsReport, *, never: bool) -> list[Suggestion]:
    """never: also the pairs that did not meet in any pose, which proves nothing."""
    return [pair for pair in report.suggestions if never or pair.why != "never"]


def toml(report: SuggestionsReport, pairs: Iterable[Suggestion]) -> str:
    """A scene file of `[[rules]]` alone; the reason of each says that it is to be confirmed."""
    blocks = [f"# {_left_out(pair)}" for pair in report.unchecked if pair.adjacent]
    blocks += [
        "\n".join(
            (
                "[[rules]]",
                f"a = {quoted(Selector.writable(pair.a).text)}",
                f"b = {quoted(Selector.writable(pair.b).text)}",
                "allowed = true",
                f"reason = {quoted(f'suggested: {evidence(pair, report)}; confirm')}",
            )
        )
        for pair in pairs
    ]
    return "\n".join((RULES_ALONE, *(f"{block}\n" for block in blocks)))


def srdf(suggestions: Suggestions, pairs: Iterable[Suggestion], robot: str) -> str:
    """A line for each two links with a suggested pair of bodies, by the strongest of their reasons;
    no "Never" where some of their bodies may meet. robot: its name.

    None where some of their bodies could not be checked: a comment says so in its place."""
    unchecked = {
        frozenset(pair.links): pair
        for pair in suggestions.report.unchecked
        if pair.links is not None
    }
    lines = {links: _comment(_left_out(pair)) for links, pair in unchecked.items() if pair.adjacent}
    for reason, a, b in _links(pairs):
        if reason == _SRDF_REASONS["never"] and frozenset((a, b)) in suggestions.may_meet:
            continue
        links = frozenset((a, b))
        attributes = f"link1={quoteattr(a)} link2={quoteattr(b)} reason={quoteattr(reason)}"
        line = f"<disable_collisions {attributes}/>"
        if links in unchecked:
            line = _comment(_left_out(unchecked[links]))
        lines.setdefault(links, line)
    inner = "".join(f"  {line}\n" for line in lines.values())
    return f"<robot name={quoteattr(robot)}>\n{inner}</robot>\n"


def _links(pairs: Iterable[Suggestion]) -> Iterator[tuple[str, str, str]]:
    """Reasons that disable most first, so that a link pair gets the strongest of its bodies."""
    of_robot = [pair for pair in pairs if pair.links is not None]
    for why, reason in _SRDF_REASONS.items():
        for pair in of_robot:
            if pair.why == why and pair.links is not None:
                yield reason, *pair.links


def evidence(pair: Suggestion, report: SuggestionsReport) -> str:
    """`penetrating by 0.2 mm at the placement`."""
    said = []
    if pair.why == "adjacent":
        said.append("a joint connects them")
    if pair.relation is not None and pair.relation != "separated":
        said.append(f"{_contact(pair, unit_of(report.units))} at the placement")
    if report.poses and pair.contacts is not None:
        poses = _poses(report)
        if pair.why == "never":
            said.append(f"never in contact in {poses}, which is no proof")
        else:
            said.append(f"in contact in {pair.contacts:,} of {poses}")
    return ", ".join(said)


def remark(suggestions: Suggestions, pairs: Iterable[Suggestion], *, never: bool) -> str:
    """A few lines for standard error."""
    report = suggestions.report
    said = counted(len(list(pairs)), "pair") + " suggested: confirm each before you allow it."
    left = sum(pair.why == "never" for pair in report.suggestions)
    if left and not never:
        poses = _poses(report)
        said += f" {counted(left, 'more pair')} never met in {poses}, which proves nothing:"
        said += " --never suggests them."
    if left_out := sum(pair.adjacent for pair in report.unchecked):
        pairs_left = counted(left_out, "pair")
        said += f" Not suggested, as not checked: {pairs_left} with a joint between the links."
    for (a, b), reason in islice(suggestions.undecided.items(), _NAMED):
        said += f"\nNot decided: {a} and {b}: {reason.removeprefix('undecided: ')}"
    if (more := len(suggestions.undecided) - _NAMED) > 0:
        said += f"\nNot decided: {counted(more, 'more pair')}"
    return said


def _left_out(pair: Unchecked) -> str:
    """A comment of one line, whatever the names hold."""
    joined = "a joint connects them, but " if pair.adjacent else ""
    why = f"{joined}they could not be checked: {pair.reason}"
    text = f"not suggested: {pair.a} and {pair.b}: {why}"
    return "".join(c if c.isprintable() else "?" for c in text)


def _comment(text: str) -> str:
    """XML lets no comment hold `--`."""
    return f"<!-- {re.sub('-(?=-)', '- ', text)} -->"


def _poses(report: SuggestionsReport) -> str:
    """`20 random poses with 1 joint held`."""
    poses = counted(report.poses, "pose" if report.seed is None else "random pose")
    return poses + (f" with {counted(len(report.held), 'joint')} held" if report.held else "")


def _contact(pair: Suggestion, unit: str | None) -> str:
    if pair.relation not in OVERLAPS or pair.depth_bounds is None:
        return str(pair.relation)
    low, high = pair.depth_bounds
    exactly = number(low) == number(high)
    figure = number(high) if exactly else f"at most {number(high)}"
    return f"{pair.relation} by {with_unit(figure, unit)}"


def quoted(text: str) -> str:
    """A basic string of TOML: that of JSON, but for DEL."""
    return escaped(json.dumps(text, ensure_ascii=False))
