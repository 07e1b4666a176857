"""A whole report: every finding by its certificate, and whether its summary follows from them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

from msgspec import UNSET, UnsetType
from msgspec.structs import replace

from satcheck._version import __version__
from satcheck.report.regions import Regions
from satcheck.report.report import (
    EFFECTS,
    ENOUGH_FAILURES,
    MEETINGS_OF_BODY,
    SUPPORT_OPEN,
    UNSUPPORTED,
    Exempt,
    Finding,
    PairCounts,
    RuleReport,
    Summary,
    Tool,
)
from satcheck.report.request import Request, request_of
from satcheck.report.rule_book import RuleBook
from satcheck.report.statics import Statics
from satcheck.report.verdict import fails, summarise
from satcheck.report.verification import Checked, CheckedSupport, Outcome, VerificationReport
from satcheck.scene.rules import Members
from satcheck.verify.bodies import Bodies, Missing, Placed, Unread
from satcheck.verify.coverage import CERTIFIED, uncovered
from satcheck.verify.distances import boxes_apart
from satcheck.verify.exact import NotCertified, Rejected
from satcheck.verify.figures import check_id, check_no_figures
from satcheck.verify.findings import Proven, check_finding
from satcheck.verify.published import report_of

ACROSS = {"xy": 2, "yz": 0, "xz": 1}
SUPPORT_CODES = frozenset((UNSUPPORTED, SUPPORT_OPEN))


def verify(
    document: Any,
    root: Path,
    progress: Callable[[int, int], None] | None = None,
    *,
    allow_outside: bool = False,
) -> VerificationReport:
    """Re-check a report, parsed from JSON, from the mesh files. Their paths start at root.

    allow_outside: the buffers of a glTF file may lie outside of its folder. Raises Rejected if the
    document is no report. Every other fault is part of the result.
    """
    report = _Report(document, root, allow_outside=allow_outside)
    count = len(report.findings)
    checked = []
    for done, finding in enumerate(report.findings, 1):
        checked.append(report.check(finding))
        if progress is not None:
            progress(done, count)
    support: tuple[CheckedSupport, ...] = ()
    pruned = exempt = 0
    if not report.missing:
        support = tuple(report.check_answers())
        pruned, exempt, left_open = report.check_unlisted()
        try:
            report.check_summary(pruned, left_open)
        except Rejected as why:
            report.faults.append(str(why))
    outcomes = {f.outcome for f in checked} | {f.outcome for f in support}
    whole = not (report.faults or report.beyond or report.missing)
    return VerificationReport(
        tool=Tool("satcheck", __version__),
        accepted=whole and outcomes <= {"accepted", "open"},
        findings=tuple(checked),
        faults=tuple(report.faults),
        not_certified=tuple(report.beyond),
        pruned=pruned,
        exempt=exempt,
        missing=report.missing,
        support=support or UNSET,
        not_covered=uncovered(document, (field for finding in checked for field in finding.left)),
    )


def is_certified(result: VerificationReport, document: Any) -> bool:
    """Return whether the report was made with certificates, has some, or needs none."""
    outcomes = {finding.outcome for finding in result.findings}
    asked = any(e["effect"] == "certificate" and e["asked_by"] for e in document["effects"])
    return asked or "not certified" not in outcomes or bool(outcomes & {"accepted", "rejected"})


class _Report:
    def __init__(self, document: Any, root: Path, *, allow_outside: bool) -> None:
        self.report, self.findings = report_of(document)
        report = self.report
        reader = Bodies(
            root,
            allow_open=report.settings.allow_open,
            allow_outside=allow_outside,
            reading=report.reading or {},
        )
        placed = reader.place_all(report.bodies, report.settings.planar)
        self.bodies = {body.id: body for body in placed}
        if len(self.bodies) < len(placed):
            raise Rejected("not a report: two bodies have one id")
        self.units = {body.id: body.units for body in report.bodies}
        self.book = rule_book(report.exempt, report.rules, placed)
        self.order = {id_: k for k, id_ in enumerate(self.bodies)}
        self.listed: set[frozenset[str]] = set()
        self.listed_apart = 0  # of these, pairs that may be apart by their boxes
        absent = [str(body.lost) for body in placed if isinstance(body.lost, Missing)]
        self.missing = tuple(dict.fromkeys(absent))
        unplaced = [b for b in placed if b.lost and not isinstance(b.lost, Missing | Unread)]
        self.faults = [f"{b.id}: {b.lost}" for b in unplaced]
        self.beyond: list[str] = []
        strangers = [i.body for i in report.issues if i.body not in {None, *self.bodies}]
        self.faults += [f"an issue is about {name}, which is no body" for name in strangers[:1]]
        if report.support is None and any(i.code in SUPPORT_CODES for i in report.issues):
            self.faults.append("issues are about the support of bodies, and its section is missing")
        if report.motions:
            self.beyond.append("bodies move: what happens on the way is not certified")
        if report.summary.accepted and report.summary.verdict != "fail":
            self.beyond.append("a baseline accepts findings: without it the check does not pass")

    def check(self, finding: Finding | Checked) -> Checked:
        a, b, relation = finding.a, finding.b, finding.relation
        if isinstance(finding, Checked):
            self._list(a, b)
            return finding
        try:
            proven = self._check(finding)
        except Missing as why:
            return Checked(a, b, relation, "no file", f"{why} is not there")
        except NotCertified as why:
            return Checked(a, b, relation, "not certified", str(why))
        except Rejected as why:
            outcome: Outcome = "rejected" if finding.certificate else "not certified"
            return Checked(a, b, relation, outcome, str(why))
        except Exception as error:  # noqa: BLE001  what a forger found is no reason to stop
            reason = f"cannot be checked: {type(error).__name__}: {error}"
            return Checked(a, b, relation, "rejected", reason)
        if proven is None:
            return Checked(a, b, relation, "open", str(finding.reason))
        left = (
            field
            for field, name in CERTIFIED.items()
            if _says_something(name, getattr(finding, name)) and name not in proven.fields
        )
        off = None if finding.distance is None else proven.distance
        return Checked(
            *(a, b, relation, "accepted", None),
            depth="depth_bounds" in proven.fields,
            mtv="mtv" in proven.fields,
            thickness={"ball", "thickness"} <= proven.fields and finding.thickness is not None,
            distance_error=None if off is None else float(off),
            left=tuple(left),
        )

    def _list(self, *names: str) -> tuple[Placed, Placed]:
        """The bodies of a finding, from now on one of the pairs that are listed."""
        if not all(name in self.bodies for name in names):
            raise Rejected("it names a body that the report does not have")
        a, b = (self.bodies[name] for name in names)
        if self.order[a.id] >= self.order[b.id] or frozenset(names) in self.listed:
            raise Rejected("every pair is listed once, in the order of the bodies")
        self.listed.add(frozenset(names))
        return a, b

    def _check(self, finding: Finding) -> Proven | None:
        a, b = self._list(finding.a, finding.b)
        if not self.book.is_checked(self.order[a.id], self.order[b.id]):
            raise Rejected("the scene does not ask about this pair")
        if (finding.motion is None) is not (finding.placed_relation is None):
            raise Rejected("the relation as placed comes with a motion")
        if finding.motion is not None:
            raise NotCertified("what happens while bodies move is not certified")
        request = self.request_of(a, b)
        unknown = any(body.claims and body.bounds is None for body in (a, b))
        self.listed_apart += unknown or boxes_apart(a, b, request)
        if finding.relation == "indeterminate":
            claims = finding.severity, finding.undecided, finding.certificate
            if claims != ("warning", "relation", None):
                raise Rejected("an indeterminate pair is a warning, and proves nothing")
            check_id(finding)
            check_no_figures(finding)
            return None
        if self.units[a.id] != self.units[b.id]:
            raise Rejected("its bodies are in different units, or in none that is stated")
        for body in (a, b):
            if isinstance(body.lost, Missing):
                raise body.lost
        return check_finding(finding, a, b, request)

    def request_of(self, a: Placed, b: Placed) -> Request:
        """Return what the settings and the rules ask of this pair."""
        settings, terms = self.report.settings, self.book.terms(self.order[a.id], self.order[b.id])
        across = None if settings.planar is None else ACROSS[settings.planar]
        return request_of(terms, settings, across)

    def check_unlisted(self) -> tuple[int, int, int]:
        """The number of unlisted pairs whose boxes are apart, of exempt ones, and of those that
        nothing decides: a body cannot be used or compared, or so many findings fail or are
        undecided that the check has stopped."""
        pruned = exempted = left_open = 0
        fail_on = self.report.settings.fail_on
        failures = sum(
            f.relation == "indeterminate" or fails(f, fail_on)
            for f in self.findings
            if isinstance(f, Finding)
        )
        meetings = sum(f.relation not in ("separated", "near") for f in self.findings)
        most_meetings = ENOUGH_FAILURES + MEETINGS_OF_BODY * len(self.bodies)
        for a, b in combinations(self.bodies.values(), 2):
            if frozenset((a.id, b.id)) in self.listed:
                continue
            if not self.book.is_checked(self.order[a.id], self.order[b.id]):
                exempted += 1
            elif self.units[a.id] != self.units[b.id] or not (a.claims and b.claims):
                left_open += 1
            elif boxes_apart(a, b, self.request_of(a, b)):
                pruned += 1
            elif failures >= ENOUGH_FAILURES or meetings >= most_meetings:
                left_open += 1
            else:
                fault = f"{a.id} and {b.id} are not apart by their boxes, and not listed"
                self.faults.append(fault)
        return pruned, exempted, left_open

    def check_answers(self) -> Iterator[CheckedSupport]:
        """The answers about the support of bodies, then those about bodies in regions; none of a
        part that has a fault."""
        parts = ("support", self.report.support), ("regions", self.report.regions)
        for part, stated in parts:
            try:
                yield from tuple(_answers(stated, self.bodies))
            except Rejected as why:
                self.faults.append(f"{part}: {why}")
            except Exception as error:  # noqa: BLE001  what a forger found is no reason to stop
                self.faults.append(f"{part} cannot be checked: {type(error).__name__}: {error}")

    def check_summary(self, pruned: int, left_open: int) -> None:
        """Rejects a summary that does not follow from the findings. Nothing does if one of them is
        ill-formed. pruned: pairs without a finding whose boxes are apart. left_open: pairs without
        a finding that nothing decides."""
        report, findings = self.report, [f for f in self.findings if isinstance(f, Finding)]
        if len(findings) < len(self.findings):
            return
        total, allowed = self.book.count()
        stated, bodies = report.summary.pairs, len(report.bodies)
        indeterminate = left_open + sum(f.relation == "indeterminate" for f in findings)
        pairs = PairCounts(
            total=total,
            pruned=stated.pruned,
            decided=total - allowed - indeterminate - stated.pruned,
            allowed=allowed,
            indeterminate=indeterminate,
            exempt=bodies * (bodies - 1) // 2 - total,
        )
        for key in ("total", "allowed", "indeterminate", "exempt"):
            if (count := getattr(stated, key)) != (follows := getattr(pairs, key)):
                raise Rejected(f"the summary counts {count!r} pairs as {key}, not {follows!r}")
        if stated.pruned != pruned and not (pruned == 0 and stated.pruned <= self.listed_apart):
            raise Rejected("the summary's count of pruned pairs is not that of the boxes apart")
        summary = replace(report.summary, pairs=pairs)
        expected = summarise(replace(report, findings=tuple(findings), summary=summary))
        for key in Summary.__struct_fields__:
            if getattr(report.summary, key) != (follows := getattr(expected, key)):
                raise Rejected(f"the summary's {key} that follows from the findings is {follows!r}")
        names = Counter(effect.effect for effect in report.effects)
        steps = set(EFFECTS) if report.motions else set(EFFECTS) - {"sweep"}
        if names.keys() != steps or names.total() > len(names):
            raise Rejected("the list of effects has each of them once")
        for effect in report.effects:
            if effect.pairs + sum(effect.not_run.values()) != total:
                raise Rejected(f"the pairs of the effect {effect.effect} are not all pairs")
        truncated = report.truncated
        if (0 if truncated is None else truncated.pairs) != pruned + left_open:
            raise Rejected(f"the findings leave out {pruned + left_open} pairs")
        # Those that fail have a state if there is a baseline, and no others.
        for finding in findings:
            has_state = report.baseline is not None and fails(finding, report.settings.fail_on)
            if report.baseline and finding.undecided and finding.baseline_state == "accepted":
                continue
            if (finding.baseline_state is not None) != has_state:
                raise Rejected(f"{finding.a} and {finding.b}: the baseline_state is out of place")


def _answers(
    part: Statics | Regions | UnsetType | None, bodies: Mapping[str, Placed]
) -> Iterator[CheckedSupport]:
    """What a part of the report claims about single bodies."""
    if isinstance(part, Statics):
        from satcheck.verify.statics.claims import Claims

        yield from Claims(part, bodies).judged()
    elif part:
        from satcheck.verify.answers import judged

        yield from judged(part, bodies)


def _says_something(name: str, value: Any) -> bool:
    """A lower end of 0 says nothing."""
    return value is not None and not (name in ("depth_bounds", "thickness_bounds") and not value[0])


def rule_book(exempt: Exempt, rules: Sequence[RuleReport], bodies: Sequence[Placed]) -> RuleBook:
    """Return the rules of a report, compiled for its bodies."""
    members = Members(bodies)
    return RuleBook(
        bodies,
        rules,
        [(members.of(rule.a), members.of(rule.b)) for rule in rules],
        frozenset(exempt.groups),
        check_static=not exempt.static_pairs,
    )
