"""Suggested rules, ready to be pasted: in TOML, or as lines of an SRDF."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from msgspec import Struct

from satcheck.audit.bodies import SUGGESTED
from satcheck.audit.suggest import LOOSER, MARGIN, NO_FIGURE
from satcheck.audit.words import counted, with_unit
from satcheck.report.json import escaped
from satcheck.scene.rules import Selector
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.audit.suggest import Suggestions
    from satcheck.report.suggestions import Suggestion, SuggestionsReport, Unchecked, Why

# Of pairs that are not decided at most so many are named, and of assets.
_NAMED = 5
# Words of the MoveIt setup assistant, which takes any other for "User". Strongest first. An SRDF
# has no limits.
_SRDF_REASONS: dict[Why, str] = {"adjacent": "Adjacent", "always": "Default", "never": "Never"}
_LAST_NUMBER = re.compile(r"\d+(?=\D*$)")


class Rule(Struct, frozen=True):
    """Two selectors, and the suggestions that they cover. others: other pairs that they cover."""

    a: str
    b: str
    pairs: Sequence[Suggestion]
    others: int = 0

    @property
    def limits(self) -> dict[str, float]:
        """What every pair keeps, of the figures that are known of all."""
        of_all = {
            name: [getattr(pair, name) for pair in self.pairs]
            for name in ("max_thickness", "max_depth")
        }
        known = {name: max(own) for name, own in of_all.items() if None not in own}
        return known or {name: max(kept) for name, own in of_all.items() if (kept := _known(own))}

    @property
    def milder(self) -> int:
        """The number of pairs that the limits let overlap more than they do, beyond the margin."""
        limits = self.limits
        own = sum(
            not all(_alike(getattr(pair, name), most) for name, most in limits.items())
            for pair in self.pairs
        )
        return self.others + own if self.pairs[0].why == "contact" else 0

    @property
    def worst(self) -> list[str]:
        """The assets that set the limits."""
        found = (
            next(pair for pair in self.pairs if getattr(pair, name) == most)
            for name, most in self.limits.items()
        )
        return [*dict.fromkeys(pair.asset for pair in found if pair.asset is not None)]

    @property
    def is_group(self) -> bool:
        """Return whether one rule stands for several pairs: they have the same limits, up to the
        margin, and no other pair has such names."""
        said = {(p.why, p.max_thickness is None, p.max_depth is None) for p in self.pairs}
        are_alike = len(said) == 1 and self.pairs[0].why == "contact" and not self.milder
        return len(self.pairs) > 1 and are_alike


def _known(values: Iterable[float | None]) -> list[float]:
    return [value for value in values if value is not None]


def _alike(limit: float | None, largest: float) -> bool:
    return limit is not None and largest <= limit * MARGIN


def rules_of(suggestions: Suggestions, pairs: Iterable[Suggestion]) -> list[Rule]:
    """Return a rule for two names, or one for all whose last numbers differ, if they are a group.
    They stand in the order of their first pairs."""
    left = {pair: place for place, pair in enumerate(pairs)}
    covered = _counter(suggestions)
    rules: dict[int, Rule] = {}
    numbered, exact = _numbered, _exact
    for of_a, of_b in ((numbered, numbered), (numbered, exact), (exact, numbered), (exact, exact)):
        groups: dict[frozenset[str], list[Suggestion]] = {}
        for pair in left:
            groups.setdefault(frozenset((of_a(pair.a), of_b(pair.b))), []).append(pair)
        for members in groups.values():
            a, b = of_a(members[0].a), of_b(members[0].b)
            rule = Rule(a, b, members, covered(a, b) - len(members))
            if rule.is_group or (of_a, of_b) == (exact, exact):
                rules[left[members[0]]] = rule
                for pair in members:
                    del left[pair]
    return [rules[place] for place in sorted(rules)]


def _counter(suggestions: Suggestions) -> Callable[[str, str], int]:
    """Return a function that counts the pairs that two selectors cover, in all assets."""
    assets: dict[str, list[str | None]] = {}
    for asset, ids in suggestions.ids.items():
        for id_ in ids:
            assets.setdefault(id_, []).append(asset)
    choose = cache(lambda selector: frozenset(Selector(selector).choose(assets)))

    def count(a: str, b: str) -> int:
        in_a, in_b, in_both = (
            Counter(asset for id_ in ids for asset in assets[id_])
            for ids in (choose(a), choose(b), choose(a) & choose(b))
        )
        return sum(
            number * in_b[asset] - in_both[asset] * (in_both[asset] + 1) // 2
            for asset, number in in_a.items()
        )

    return count


def _exact(name: str) -> str:
    return Selector.writable(name).text


def _numbered(name: str) -> str:
    """`bolt.*` for `bolt.001`."""
    return _exact(_LAST_NUMBER.sub("\0", name)).replace("\0", "*")


def toml(suggestions: Suggestions, pairs: Iterable[Suggestion]) -> str:
    """Return a scene file of `[[rules]]` alone; the reason of each says that it is to be
    confirmed."""
    report = suggestions.report
    unit = unit_of(report.units)
    head = '# Give this file beside the scene, or after --rules.\nschema = "satcheck.scene/1"\n'
    head += (f'units = "{unit}"\n' if unit else "") + "bodies = []\n"
    rules = rules_of(suggestions, pairs)
    head += "" if rules else "rules = []\n"
    blocks = [
        f"# not suggested: {_left_out(pair)}"
        for pair in report.unchecked
        if pair.adjacent or pair.reason == NO_FIGURE or pair.reason.startswith(LOOSER)
    ]
    blocks = [*dict.fromkeys(blocks)]  # several assets may have pairs of the same names
    blocks += ["\n".join(_lines(rule, report)) for rule in rules]
    return "\n".join((head, *(f"{block}\n" for block in blocks)))


def _lines(rule: Rule, report: SuggestionsReport) -> Iterator[str]:
    yield from ("[[rules]]", f"a = {quoted(rule.a)}", f"b = {quoted(rule.b)}")
    yield from (f"{name} = {most!r}" for name, most in rule.limits.items())
    if rule.pairs[0].why != "contact":
        yield "allowed = true"
    yield f"reason = {quoted(f'{SUGGESTED}{evidence(rule, report)}; confirm')}"


def evidence(rule: Rule, report: SuggestionsReport) -> str:
    """`penetrating, thickness 0.2 mm, depth 3 mm as placed; the limits add 10 %`."""
    pairs, first, unit = rule.pairs, rule.pairs[0], unit_of(report.units)
    said = [counted(len(pairs), "pair")] if len(pairs) > 1 else []
    said += ["a joint connects them"] if first.why == "adjacent" else []
    placed = [pair.relation for pair in pairs if pair.relation not in (None, "separated")]
    said += [" or ".join(sorted(set(map(str, placed))))] if placed else []
    for name in ("thickness", "depth"):
        ends = _known(own and own[1] for own in (getattr(p, f"{name}_bounds") for p in pairs))
        said += [f"{name} {with_unit(f'{max(ends):.3g}', unit)}"] if ends else []
    said[-1:] = [f"{said[-1]} as placed"] if placed else said[-1:]
    if first.why == "never":
        said.append(f"never in contact in {_poses(report)}, which is no proof")
    elif first.contacts is not None and len(pairs) == 1:
        said.append(f"in contact in {first.contacts:,} of {_poses(report)}")
    names = sorted({pair.asset for pair in pairs if pair.asset is not None})
    said += [f"in {', '.join(names[:_NAMED])}{', ...' if names[_NAMED:] else ''}"] if names else []
    margin = "; the limits add 10 %" if first.why == "contact" else ""
    if milder := rule.milder:
        need = counted(milder, "pair of these names needs", "pairs of these names need")
        margin += f" to {' and '.join(rule.worst)}: {need} less"
    return ", ".join(said) + margin


def srdf(suggestions: Suggestions, pairs: Iterable[Suggestion], robot: str) -> str:
    """Return a line for each two links with a suggested pair of bodies, by the strongest of their
    reasons, with the evidence as a comment; no "Never" where some of their bodies may meet. Where
    some of their bodies could not be checked, a comment says so instead. robot: its name."""
    report = suggestions.report
    unchecked = {frozenset(pair.links): pair for pair in report.unchecked if pair.links is not None}
    lines = {links: _why_not(pair) for links, pair in unchecked.items() if pair.adjacent}
    order = list(_SRDF_REASONS)
    of_links = [pair for pair in pairs if pair.links is not None and pair.why in order]
    for pair in sorted(of_links, key=lambda pair: (order.index(pair.why), -(pair.contacts or 0))):
        a, b = pair.links or ("", "")
        links = frozenset((a, b))
        if links in lines or (pair.why == "never" and links in suggestions.may_meet):
            continue
        if links in unchecked:
            lines[links] = _why_not(unchecked[links])
            continue
        line = f"<disable_collisions link1={quoteattr(a)} link2={quoteattr(b)} "
        line += f'reason="{_SRDF_REASONS[pair.why]}"/> '
        lines[links] = line + _comment(evidence(Rule(pair.a, pair.b, [pair]), report))
    inner = "".join(f"  {line}\n" for line in lines.values())
    return f"<robot name={quoteattr(robot)}>\n{inner}</robot>\n"


def remark(suggestions: Suggestions, pairs: Sequence[Suggestion], *, never: bool) -> str:
    """Return a few lines for standard error."""
    report = suggestions.report
    said = "No pair is suggested."
    if pairs:
        said = counted(len(pairs), "pair") + " suggested: confirm each before you allow it."
    left = sum(pair.why == "never" for pair in report.suggestions)
    if left and not never:
        poses = _poses(report)
        said += f" {counted(left, 'more pair')} never met in {poses}, which proves nothing:"
        said += " --never suggests them."
    if left_out := sum(pair.adjacent for pair in report.unchecked):
        pairs_left = counted(left_out, "pair")
        said += f" Not suggested, as not checked: {pairs_left} with a joint between the links."
    looser = Counter(_left_out(pair) for pair in report.unchecked if pair.reason.startswith(LOOSER))
    for text, count in looser.items():
        said += f"\nNot suggested: {text} ({counted(count, 'asset')})"
    if loose := [rule for rule in rules_of(suggestions, pairs) if rule.milder]:
        largest = max(loose, key=lambda rule: max(rule.limits.values()))
        rules = counted(len(loose), "rule lets", "rules let")
        said += (
            f"\n{rules} some pairs overlap more than they do: a rule goes by names, in all assets "
            f"alike, and the worst sets its limits, as {largest.a} and {largest.b} in "
            f"{' and '.join(largest.worst)}."
        )
    if assets := suggestions.without_unit:
        named = ", ".join((*assets[:_NAMED], *(("...",) if assets[_NAMED:] else ())))
        said += (
            f"\n{named}: no unit is stated, and lengths count in {unit_of(report.units)}, as in a "
        )
        said += "check with these rules. --units states another unit."
    undecided = [each for each in suggestions.undecided.items() if not each[1].startswith(LOOSER)]
    for pair, reason in undecided[:_NAMED]:
        said += f"\nNot decided: {pair}: {reason.removeprefix('undecided: ')}"
    if (more := len(undecided) - _NAMED) > 0:
        said += f"\nNot decided: {counted(more, 'more pair')}"
    return said


def _left_out(pair: Unchecked) -> str:
    """Return the pair and the reason in one line, whatever the names hold."""
    joined = "a joint connects them, but " if pair.adjacent else ""
    is_known = pair.reason.startswith(LOOSER)
    why = pair.reason if is_known else f"{joined}they could not be checked: {pair.reason}"
    text = f"{pair.a} and {pair.b}: {why}"
    return "".join(c if c.isprintable() else "?" for c in text)


def _why_not(pair: Unchecked) -> str:
    return _comment(f"not suggested: {_left_out(pair)}")


def _comment(text: str) -> str:
    """XML lets no comment hold `--`, or end with a hyphen."""
    return f"<!-- {re.sub('-(?=-)', '- ', text)} -->"


def _poses(report: SuggestionsReport) -> str:
    """`20 random poses with 1 joint held`."""
    poses = counted(report.poses, "pose" if report.seed is None else "random pose")
    return poses + (f" with {counted(len(report.held), 'joint')} held" if report.held else "")


def quoted(text: str) -> str:
    """Return a basic string of TOML: that of JSON, but for DEL."""
    return escaped(json.dumps(text, ensure_ascii=False))
