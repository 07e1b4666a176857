"""What a report counts: bodies, pairs, relations, findings beside a baseline; and the next step."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from msgspec import Struct, field

from satcheck.audit.acceptance import words_to_accept
from satcheck.audit.messages import is_unsure, of_command
from satcheck.audit.words import counted, is_hit, is_unusable, number
from satcheck.report.report import CROSS_CHECK, OVERLAPS, RELATIONS
from satcheck.report.verdict import exempt_by, is_failure
from satcheck.scene.bodies import UNITS_UNKNOWN

if TYPE_CHECKING:
    from satcheck.report.baseline import BaselineState
    from satcheck.report.report import Finding, Issue, Report
    from satcheck.report.settings import StatedConfig
    from satcheck.report.sweep import Sweep

_WORDS = {"contains": "containing"}
# What the meshes of a code of issues are.
MESHES = {
    "not-closed": ("open mesh", "open meshes"),
    "cracks": ("mesh with closed cracks", "meshes with closed cracks"),
    "not-manifold": ("non-manifold mesh", "non-manifold meshes"),
    "misoriented": ("inconsistently wound mesh", "inconsistently wound meshes"),
    "inside-out": ("turned mesh", "turned meshes"),
    "doubtful-cavity": ("mesh with doubtful cavities", "meshes with doubtful cavities"),
    "double-sided": ("double-sided mesh", "double-sided meshes"),
    "flat": ("flat mesh", "flat meshes"),
    "no-volume": ("mesh without volume", "meshes without volume"),
    "degenerate-triangles": ("mesh with empty triangles", "meshes with empty triangles"),
    "duplicate-triangles": ("mesh with repeated triangles", "meshes with repeated triangles"),
}


def issues_to_tell(report: Report) -> list[Issue]:
    """Return the issues but those about meshes that are open on purpose, which JSON has."""
    named: dict[bool, set[str]] = {True: set(), False: set()}
    for body in report.bodies:
        named[body.open or report.settings.allow_open].update((body.id, body.file))
    told = named[True] - named[False]
    return [i for i in report.issues if i.code != "not-closed" or (i.body or i.file) not in told]


_STATES: tuple[BaselineState, ...] = ("accepted", "new", "worse", "undecided")
_KNOWN: tuple[BaselineState, ...] = ("unchanged", "accepted", "worse", "undecided")
_UNKNOWN = " It knows none of these: it names assets by their paths from its own folder."
_UNDECIDED = (
    " An undecided finding has no figure to compare, or one that is too wide or in another unit: "
    "add --depth, --clearance or --volume, or update the baseline."
)


def counts_line(report: Report) -> str:
    """`3 bodies, 3 pairs: 2 separated, 1 penetrating; 1 pair exempt (static).`"""
    pairs = report.summary.pairs
    line = f"{counted(len(report.bodies), 'body', 'bodies')}, {counted(pairs.total, 'pair')}"
    if pairs.asked:
        counts = _counts(report)
        if pairs.allowed:
            counts.append(f"{pairs.allowed:,} allowed")
        line += f": {', '.join(counts)}{_exempt(report) if pairs.exempt else ''}"
    more = _hits(report)
    if report.baseline is not None:
        beside = BesideBaseline()
        beside.note(report)
        more += beside.lines()
    if report.settings.cross_check:
        more.append(_cross_check(report))
    return " ".join([f"{line}.", *more])


def _exempt(report: Report) -> str:
    """`; 1 pair exempt (static)`: of pairs that no other count includes."""
    still = sum(body.static for body in report.bodies) if report.exempt.static_pairs else 0
    static, in_group = exempt_by(report.summary.pairs, still)
    if static and in_group:
        why = f"{static:,} static, {in_group:,} within ignored groups"
    else:
        why = "static" if static else "within ignored groups"
    return f"; {counted(report.summary.pairs.exempt, 'pair')} exempt ({why})"


def _counts(report: Report) -> list[str]:
    """`2 separated`, `1 possibly penetrating (not proven at --accuracy aabb)`."""
    accuracy = report.settings.accuracy
    why = "" if accuracy == "exact" else f" (not proven at --accuracy {accuracy})"
    guesses = [f for f in report.findings if f.quality == "estimate"]
    overlaps = Counter(
        f.relation for f in guesses if f.at_rest in OVERLAPS and not is_unsure(f, report)
    )
    estimates = Counter(f.relation for f in guesses) - overlaps
    counts = []
    for name in RELATIONS:
        word, unproven = _WORDS.get(name, name), estimates[name]
        proven = report.summary.by_relation.get(name, 0) - unproven - overlaps[name]
        if proven:
            counts.append(f"{proven:,} {word}")
        if unproven:
            counts.append(f"{unproven:,} possibly {word}{why}")
    if count := overlaps.total():
        counts.append(f"{count:,} overlapping in a way that is not proven")
    return counts


def _hits(report: Report) -> list[str]:
    """Of pairs that do not overlap as they are placed."""
    hits = [f.motion for f in report.findings if is_hit(f) and f.at_rest not in OVERLAPS]
    proven = Counter(hit is not None and hit.proven for hit in hits)
    said = []
    for count, possibly in ((proven[True], ""), (proven[False], "possibly ")):
        if count:
            said.append(counted(count, f"pair {possibly}hits", f"pairs {possibly}hit"))
    if not said:
        return []
    first = min((hit for hit in hits if hit is not None), key=_first_time)
    since = f", the first at t = {number(_first_time(first))}" if len(hits) > 1 else ""
    return [f"{' and '.join(said)} in motion{since}."]


def _first_time(hit: Sweep) -> float:
    return hit.time_of_impact[1] if hit.time_of_impact else 0.0


def _cross_check(report: Report) -> str:
    """`Cross-check: 5 answers agree, 1 disagrees, 1 pair not asked.`, an answer being that of one
    library on a pair. A missing answer is counted apart, not as agreement."""
    standings: Counter[str] = Counter()
    asked = 0
    for finding in report.findings:
        results = [stage.result for stage in finding.plan if stage.stage == CROSS_CHECK]
        standings.update(results)
        asked += bool(results)
    if not asked:
        return "Cross-check: no pair was asked about."
    agree, disagree = standings.pop("agrees", 0), standings.pop("disagrees", 0)
    parts = [counted(agree, "answer agrees", "answers agree")]
    if disagree:
        parts.append(counted(disagree, "disagrees", "disagree"))
    if missing := standings.total():
        parts.append(f"{missing:,} could not be had")
    if unasked := report.summary.pairs.total - report.summary.pairs.allowed - asked:
        parts.append(f"{counted(unasked, 'pair')} not asked about")
    return f"Cross-check: {', '.join(parts)}."


class BesideBaseline(Struct):
    """states: of the findings of reports that were compared with a baseline."""

    judged: int = 0
    absent: int = 0
    states: Counter[BaselineState | None] = field(default_factory=Counter)

    def note(self, report: Report) -> None:
        if report.baseline is not None:
            self.judged += 1
            self.absent += len(report.baseline.absent)
            self.states.update(finding.baseline_state for finding in report.findings)

    def lines(self) -> list[str]:
        """`Baseline: 2 known findings, 1 new; 1 more passes now: satcheck baseline prune.`
        Nothing without a baseline."""
        if not self.judged:
            return []
        parts = [counted(self.states["unchanged"], "known finding")]
        parts += [f"{self.states[s]:,} {s}" for s in _STATES if self.states[s]]
        absent = counted(self.absent, "more passes now", "more pass now")
        gone = f"; {absent}: satcheck baseline prune" if self.absent else ""
        advice = _UNDECIDED if self.states["undecided"] else ""
        if self.states["new"] and not (self.absent or any(self.states[s] for s in _KNOWN)):
            advice = _UNKNOWN
        return [f"Baseline: {', '.join(parts)}{gone}.{advice}"]


FACETED = "faceted"
# More overlaps than this are rarely mended one by one.
MANY = 10


def summary_line(report: Report) -> str:
    """`FAIL: box and lid overlap (depth 1 mm). 2 bodies, 1 pair: 1 penetrating.`"""
    return f"{report.message} {counts_line(report)}"


def closing(report: Report, *, written: bool = False) -> list[str]:
    """Return the last lines: what was counted, the verdict, and what to do next. written: the
    report goes to a file."""
    return [counts_line(report), of_command(report), *next_step(report, written=written)]


def next_step(report: Report, *, written: bool = False) -> list[str]:
    """`Next: -o report.html shows the overlaps.`; after a pass only what facets may hide. written:
    the report goes to a file."""
    steps = _after_failure(report, written) if report.summary.verdict == "fail" else _open(report)
    return [f"Next: {step}." for step in (*steps, *_within_facets(report)) if step]


def _after_failure(report: Report, written: bool) -> Iterator[str]:
    failed = [f for f in report.findings if is_failure(f, report.settings.fail_on)]
    overlaps = [f for f in failed if f.at_rest in OVERLAPS]
    if report.settings.accuracy != "exact" and any(f.quality == "estimate" for f in failed):
        yield "--accuracy exact decides what is only possible"
    elif len(overlaps) > MANY and _may_be_assets(report, len(overlaps)):
        yield "satcheck batch checks each file by itself, if they are assets of their own"
    elif len(overlaps) > MANY and report.baseline is None:
        yield "satcheck suggest proposes rules for overlaps that are intended"
    elif not written:
        yield f"-o report.html shows {'it' if len(failed) == 1 else 'them'} in 3-D"
    within = [f for f in overlaps if f.at_rest in ("contains", "inside")]
    if within and _depends_on_holes(report, within):
        yield "--allow-open, if the open meshes are meant to be open: they then have no inside"


def _may_be_assets(report: Report, overlaps: int) -> bool:
    """Return whether most files overlap each other, as those of assets do that were never meant to
    stand side by side."""
    pairs = report.summary.pairs
    is_each_a_file = len({body.file for body in report.bodies}) == len(report.bodies)
    return is_each_a_file and 2 * overlaps > pairs.total - pairs.indeterminate


def _open(report: Report) -> Iterator[str]:
    """What may decide the questions that are open, but for those of bodies that cannot be used."""
    blocking = dict.fromkeys(words_to_accept(i) for i in report.issues if i.state == "blocking")
    unusable = {body.id for body in report.bodies if is_unusable(body)}
    asked = [f for f in report.findings if f.undecided and not unusable & {f.a, f.b}]
    undecided = [f for f in asked if f.undecided in ("relation", "inside")]
    if blocking:
        yield f"{' '.join(blocking)}, if that is as meant"
    elif not asked:
        return
    elif any(issue.code == UNITS_UNKNOWN for issue in report.issues):
        yield "--units states the unit of files that have none"
    elif report.settings.accuracy != "exact":
        yield "--accuracy exact decides it"
    elif words := [*_about_insides(report, undecided)]:
        yield from words
    elif any(map(_has_no_thickness, asked)):
        yield "--max-depth, or max_depth of a rule, limits what has no thickness"
    elif any(f.undecided == "limit" and f.at_rest in OVERLAPS for f in asked):
        yield "a larger --budget may decide it"
    else:
        yield "--explain shows the steps"


def _about_insides(report: Report, undecided: Sequence[Finding]) -> Iterator[str]:
    """What decides whether a body lies in material."""
    if undecided and any(issue.code == "doubtful-cavity" for issue in report.issues):
        yield (
            "turn faces outward on solids and inward on cavities; give the walls of a room a back"
        )
    if _depends_on_holes(report, undecided):
        yield "close the holes, or give --allow-open if they are meant to be open"


def _within_facets(report: Report) -> Iterator[str]:
    """What the facets of a file excuse although a limit of this call is finer."""
    thick, deep = report.settings.max_thickness, report.settings.max_depth
    excused = sum(
        (thick is not None and (each.thickness or 0.0) > thick)
        or (deep is not None and (each.depth or 0.0) > deep)
        for each in report.findings
        if each.at_rest == "touching" and each.exact_relation in OVERLAPS
    )
    if excused and any(issue.code == FACETED for issue in report.issues):
        pairs = counted(excused, "pair overlaps", "pairs overlap")
        yield (
            f"a smaller --read chord-tolerance: {pairs} by more than the limit, and by no more "
            "than the facets may be off"
        )


def _has_no_thickness(finding: Finding) -> bool:
    return finding.undecided == "limit" and any(
        stage.stage == "thickness" and stage.result == "not known" for stage in finding.plan
    )


def _depends_on_holes(report: Report, findings: Sequence[Finding]) -> bool:
    healths = ((body.id, body.health) for body in report.bodies)
    holed = {id_ for id_, health in healths if health and health.holes and not health.doubtful}
    return not report.settings.allow_open and any(holed & {f.a, f.b} for f in findings)


def config_lines(reports: Iterable[Report]) -> list[str]:
    """A line for each config file that took effect."""
    stated = (report.config for report in reports)
    return list(dict.fromkeys(config_line(config) for config in stated if config is not None))


def config_line(config: StatedConfig) -> str:
    """`Options of satcheck.toml: tolerance = 0.1, fail-on = "warning"`."""
    options = (f"{name} = {toml(value)}" for name, value in config.options.items())
    return f"Options of {config.file}: {', '.join(options)}"


def toml(value: object) -> str:
    """The value as TOML writes it; JSON writes texts, numbers and lists of texts alike."""
    return json.dumps(value, ensure_ascii=False, default=str)
