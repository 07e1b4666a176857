"""A whole report: every finding by its certificate, and whether its summary follows from them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import Any

from satcheck.report.verification import Checked, Outcome, Uncovered
from satcheck.verify.bodies import Bodies, Placed
from satcheck.verify.coverage import uncovered
from satcheck.verify.exact import Rejected
from satcheck.verify.figures import check_id, check_no_figures
from satcheck.verify.findings import Proven, check_finding, default_tolerance
from satcheck.verify.in_plane import ACROSS, curve_error
from satcheck.verify.published import departures
from satcheck.verify.relations import OVERLAPS
from satcheck.verify.rules import ASKED, SEVERITIES, Asked, Rules

SCHEMA = "satcheck.report/1"
# Counts of the summary, and what was left undecided of the findings that they count.
UNDECIDED = (
    ("surfaces_only", "inside"),
    ("limits_undecided", "limit"),
    ("sweeps_undecided", "motion"),
    ("disputed", "cross-check"),
)
EFFECTS = ("overlap", "depth", "distance", "volume", "contacts", "cross-check", "certificate")
CERTAINLY = 1 + 1e-12  # far more than a difference of two numbers can be off by


@dataclass(frozen=True, slots=True)
class Verification:
    """faults: what is wrong with the report as a whole. beyond: what no certificate speaks of.
    exempt: pairs whose boxes meet that the report does not claim to have checked, because the scene
    exempts them. pruned: pairs that are not listed, whose boxes are apart. asked: whether the
    report says that certificates were asked for. missing: files that are not there; with some, the
    pairs that are not listed and the summary are not checked, and nothing is accepted as a whole.
    uncovered: fields with a value of which only the type was checked.
    """

    findings: tuple[Checked, ...]
    faults: tuple[str, ...]
    beyond: tuple[str, ...]
    pruned: int
    exempt: int
    asked: bool
    missing: tuple[str, ...] = ()
    uncovered: tuple[Uncovered, ...] = ()

    @property
    def accepted(self) -> bool:
        settled = all(f.outcome in ("accepted", "open") for f in self.findings)
        return settled and not (self.faults or self.beyond or self.missing)

    @property
    def rejected(self) -> bool:
        """Whether something that was checked is false."""
        return bool(self.faults) or any(f.outcome == "rejected" for f in self.findings)

    @property
    def certified(self) -> bool:
        """Whether the report was made with certificates, has some, or needs none."""
        outcomes = {f.outcome for f in self.findings}
        return (
            self.asked
            or "not certified" not in outcomes
            or bool(outcomes & {"accepted", "rejected"})
        )


def verify(
    document: Any,
    root: Path,
    progress: Callable[[int, int], None] | None = None,
    *,
    allow_outside: bool = False,
) -> Verification:
    """Re-check a report, parsed from JSON, from the mesh files. Their paths start at root.

    allow_outside: the buffers of a glTF file may lie outside of its folder. Raises Rejected where
    it is no report. Everything else that is wrong is a result.
    """
    report = _Report(document, root, allow_outside=allow_outside)
    count = len(report.findings)
    checked = []
    for number_ in range(count):
        checked.append(report.check(number_))
        if progress is not None:
            progress(number_ + 1, count)
    faults = list(report.faults)
    pruned = exempt = 0
    if not report.missing:
        pruned, exempt = report.check_unlisted(faults)
        try:
            report.check_summary(pruned)
        except Rejected as why:
            faults.append(str(why))
    return Verification(
        tuple(checked),
        tuple(faults),
        tuple(report.beyond),
        pruned,
        exempt,
        asked=_asks_for_certificates(document),
        missing=report.missing,
        uncovered=uncovered(document, (field for one in checked for field in one.left)),
    )


def _asks_for_certificates(document: dict[str, Any]) -> bool:
    return any(e["effect"] == "certificate" and e["asked_by"] for e in document["effects"])


class _NoFile(Exception):
    """What is claimed may be true: the file of a body is not there."""


class _NotCertified(Exception):
    """The claim may be true, but no certificate proves it."""


class _Report:
    def __init__(self, document: Any, root: Path, *, allow_outside: bool) -> None:
        if not isinstance(document, dict) or document.get("schema") != SCHEMA:
            raise Rejected(f'not a report: "schema" is not "{SCHEMA}"')
        self.ill_formed = departures(document)
        if None in self.ill_formed:
            raise Rejected(f"not a report by its schema: {self.ill_formed[None]}")
        self.document = document
        self.findings = document["findings"]
        self.asked = _asked(document["settings"])
        plane = document["settings"]["planar"]
        reader = Bodies(root, allow_open=self.asked.allow_open, allow_outside=allow_outside)
        placed = reader.place_all(document["bodies"], plane)
        self.bodies = {body.id: body for body in placed}
        if len(self.bodies) < len(placed):
            raise Rejected("not a report: two bodies have one id")
        self.units = {entry["id"]: entry.get("units") for entry in document["bodies"]}
        self.rules = Rules(document, self.bodies)
        self.order = {id_: k for k, id_ in enumerate(self.bodies)}
        self.listed: set[frozenset[str]] = set()
        self.listed_apart = 0  # of these, pairs that may be apart by their boxes
        absent = [body.missing for body in placed if body.missing is not None]
        self.missing = tuple(dict.fromkeys(absent))
        unplaced = [b for b in placed if b.claims and b.reason and b.missing is None]
        self.faults = [f"{b.id}: {b.reason}" for b in unplaced]
        self.beyond: list[str] = []
        self.faults += _faults_of_issues(document, self.bodies)
        if document.get("motions"):
            self.beyond.append("bodies move: what happens on the way is not certified")

    def check(self, number_: int) -> Checked:
        """The finding of this number."""
        entry = self.findings[number_]
        if not isinstance(entry, dict):
            raise Rejected("not a report: a finding is no object")
        a, b, relation = (str(entry.get(key)) for key in ("a", "b", "relation"))
        if number_ in self.ill_formed:
            self._list(entry)
            return Checked(
                a, b, relation, "rejected", f"not by the schema: {self.ill_formed[number_]}"
            )
        try:
            proven = self._check(entry)
        except _NotCertified as why:
            return Checked(a, b, relation, "not certified", str(why))
        except _NoFile as why:
            return Checked(a, b, relation, "no file", str(why))
        except Rejected as why:
            outcome: Outcome = "rejected" if entry.get("certificate") else "not certified"
            return Checked(a, b, relation, outcome, str(why))
        except Exception as error:  # noqa: BLE001  what a forger found is no reason to stop
            reason = f"cannot be checked: {type(error).__name__}: {error}"
            return Checked(a, b, relation, "rejected", reason)
        if proven is None:
            return Checked(a, b, relation, "open", str(entry.get("reason")))
        left = _left(entry, proven)
        return Checked(a, b, relation, "accepted", None, proven.depth, proven.mtv, left)

    def _list(self, entry: dict[str, Any]) -> tuple[Placed, Placed]:
        """The bodies of a finding, from now on one of the pairs that are listed."""
        names = entry.get("a"), entry.get("b")
        if not all(isinstance(name, str) and name in self.bodies for name in names):
            raise Rejected("it names a body that the report does not have")
        a, b = (self.bodies[str(name)] for name in names)
        if self.order[a.id] >= self.order[b.id] or frozenset(names) in self.listed:
            raise Rejected("every pair is listed once, in the order of the bodies")
        self.listed.add(frozenset((a.id, b.id)))
        return a, b

    def _check(self, entry: dict[str, Any]) -> Proven | None:
        a, b = self._list(entry)
        if self.rules.is_exempt(a, b):
            raise Rejected("the scene does not ask about this pair")
        if (entry["motion"] is None) is not (entry["placed_relation"] is None):
            raise Rejected("the relation as placed comes with a motion")
        if entry.get("motion") is not None:
            raise _NotCertified("what happens while bodies move is not certified")
        asked = self.asked_of(a, b)
        unknown = any(body.claims and body.bounds is None for body in (a, b))
        self.listed_apart += unknown or _boxes_apart(a, b, asked)
        if entry.get("relation") == "indeterminate":
            claims = (entry.get(key) for key in ("severity", "undecided", "certificate"))
            if tuple(claims) != ("warning", "relation", None):
                raise Rejected("an indeterminate pair is a warning, and proves nothing")
            check_id(entry)
            check_no_figures(entry)
            return None
        if self.units[a.id] != self.units[b.id]:
            raise Rejected("its bodies are in different units, or in none that is stated")
        for body in (a, b):
            if body.missing is not None:
                raise _NoFile(f"{body.missing} is not there")
        return check_finding(entry, a, b, asked)

    def asked_of(self, a: Placed, b: Placed) -> Asked:
        """What the settings ask, but for what the rules ask of this pair. A pair that may overlap
        has no clearance to keep."""
        terms = self.rules.terms(a, b)
        asked = replace(
            self.asked,
            **{key: terms[key] for key in ASKED & terms.keys()},
            names=self.rules.names(a, b),
        )
        return replace(asked, clearance=None) if asked.limited else asked

    def check_unlisted(self, faults: list[str]) -> tuple[int, int]:
        """How many pairs that are not listed are apart by their boxes, and how many are exempt."""
        pruned = exempted = 0
        for a, b in _unlisted(list(self.bodies.values()), self.listed):
            if self.rules.is_exempt(a, b):
                exempted += 1
            elif self.units[a.id] != self.units[b.id]:
                faults.append(f"{a.id} and {b.id} are not in one unit, and not listed")
            elif _boxes_apart(a, b, self.asked_of(a, b)):
                pruned += 1
            else:
                faults.append(f"{a.id} and {b.id} are not apart by their boxes, and not listed")
        return pruned, exempted

    def check_summary(self, pruned: int) -> None:
        summary = self.document["summary"]
        pairs = summary["pairs"]
        relations = Counter(str(f.get("relation")) for f in self.findings)
        total, allowed = self.rules.count()
        indeterminate = relations["indeterminate"]
        bodies = len(self.bodies)
        expected = {
            "total": total,
            "allowed": allowed,
            "indeterminate": indeterminate,
            "exempt": bodies * (bodies - 1) // 2 - total,
        }
        for key, value in expected.items():
            if pairs[key] != value:
                raise Rejected(f"the summary counts {pairs[key]!r} pairs as {key}, not {value}")
        said = pairs["pruned"]
        if said != pruned and not (pruned == 0 and 0 <= said <= self.listed_apart):
            raise Rejected("the summary's count of pruned pairs is not that of the boxes apart")
        if pairs["decided"] != total - allowed - indeterminate - said:
            raise Rejected("the summary's counts of pairs do not add up")
        relations["separated"] += pruned
        by_relation = summary["by_relation"]
        if {k: v for k, v in by_relation.items() if v} != {k: v for k, v in relations.items() if v}:
            raise Rejected("the summary's counts by relation are not those of the findings")
        undecided = Counter(str(f.get("undecided")) for f in self.findings)
        for key, kind in UNDECIDED:
            if summary[key] != undecided[kind]:
                raise Rejected(f"the summary's {key} is not {undecided[kind]}")
        fail_on = self.document["settings"]["fail_on"]
        self._check_effects(total)
        truncated = self.document["truncated"]
        if (0 if truncated is None else truncated["pairs"]) != pruned:
            raise Rejected(f"the findings leave out {pruned} pairs")
        failed = any(_fails(f, SEVERITIES.index(fail_on)) for f in self.findings)
        left_open = len(self.findings) - undecided["None"] or total == allowed
        verdict = "fail" if failed else "incomplete" if left_open else "pass"
        if summary.get("verdict") != verdict:
            raise Rejected(f"the verdict that follows from the findings is {verdict!r}")

    def _check_effects(self, total: int) -> None:
        names = Counter(effect["effect"] for effect in self.document["effects"])
        expected = {*EFFECTS, *(("sweep",) if self.document.get("motions") else ())}
        if names.keys() != expected or names.total() > len(names):
            raise Rejected("the list of effects has each of them once")
        for effect in self.document["effects"]:
            if effect["pairs"] + sum(effect["not_run"].values()) != total:
                raise Rejected(f"the pairs of the effect {effect['effect']} are not all pairs")


def _left(finding: dict[str, Any], proven: Proven) -> tuple[str, ...]:
    """The fields of an accepted finding that have a value and are not proven."""
    bounds, overlap = finding["depth_bounds"], finding["exact_relation"] in OVERLAPS
    is_left = {
        "undecided": finding["undecided"] == "limit",
        "distance": finding["distance"] is not None and not proven.distance,
        "distance_bounds": finding.get("distance_bounds") is not None and not proven.distance,
        "depth": finding["depth"] is not None and not (proven.depth or proven.mtv),
        "depth_bounds": bounds is not None and bounds[0] > 0 and not proven.depth,
        "normal": finding["normal"] is not None and not proven.normal,
        "mtv": finding["mtv"] is not None and not proven.mtv,
        "volume": overlap and finding["volume"] is not None,
        "volume_error": overlap and finding["volume_error"] is not None,
        "contacts": finding["contacts"] is not None and not proven.contacts,
    }
    return tuple(f"findings[].{key}" for key, left in is_left.items() if left)


def _faults_of_issues(document: dict[str, Any], bodies: dict[str, Placed]) -> list[str]:
    named = (issue["body"] for issue in document["issues"] if issue["body"] is not None)
    strangers = [name for name in named if name not in bodies]
    return [f"an issue is about {name}, which is no body" for name in strangers[:1]]


def _unlisted(bodies: list[Placed], listed: set[frozenset[str]]) -> Iterator[tuple[Placed, Placed]]:
    """Pairs without a finding."""
    for a, b in combinations(bodies, 2):
        if frozenset((a.id, b.id)) not in listed:
            yield a, b


def _fails(finding: dict[str, Any], least: int) -> bool:
    """What was found, and not what was left open, as grave as that."""
    severity = finding.get("severity")
    found = finding.get("undecided") is None or severity == "error"
    return found and severity in SEVERITIES[least:]


def _boxes_apart(a: Placed, b: Placed, asked: Asked) -> bool:
    if a.bounds is None or b.bounds is None:
        return False
    (low_a, high_a), (low_b, high_b) = a.bounds, b.bounds
    most = a.resolution + b.resolution if asked.tolerance is None else asked.tolerance
    widest = max((low_b - high_a).max(), (low_a - high_b).max())
    if widest <= 0:
        return False
    closer = curve_error(a, b).closer
    if widest > max(most, (asked.clearance or 0.0) + float(closer)) * CERTAINLY:
        return True
    tolerance = asked.tolerance
    if tolerance is None:
        tolerance = default_tolerance(a, b, asked.across)
    beyond = max(Fraction(tolerance), Fraction(asked.clearance or 0.0) + closer)
    exact = [
        max(Fraction(p) - Fraction(q), Fraction(r) - Fraction(s), Fraction(0))
        for p, q, r, s in zip(*(c.tolist() for c in (low_b, high_a, low_a, high_b)), strict=True)
    ]
    return sum(step * step for step in exact) > beyond * beyond


def _asked(settings: dict[str, Any]) -> Asked:
    tolerance, clearance = settings["tolerance"], settings["clearance"]
    return Asked(
        None if tolerance == "input-precision" else float(tolerance),
        None if clearance is None else float(clearance),
        settings["allow_open"],
        across=None if (plane := settings["planar"]) is None else ACROSS[plane],
    )
