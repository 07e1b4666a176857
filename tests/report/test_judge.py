"""The judgement of random findings and the summary of random reports, held against a second
derivation in rational numbers that shares no code with the first."""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction

import pytest

from satcheck.report.baseline import HELD
from satcheck.report.judge import EXACT_WIDTH, disputed, judged
from satcheck.report.report import (
    OVERLAPS,
    RELATIONS,
    BodyReport,
    Finding,
    Issue,
    PairCounts,
    Report,
    Summary,
    Tool,
)
from satcheck.report.request import LIMITS, Request
from satcheck.report.settings import StatedSettings
from satcheck.report.statics import Statics, SupportFinding
from satcheck.report.verdict import fails, summarise

RANKS = ("none", "silenced", "note", "warning", "error")
LENGTHS = (0.0, 0.125, 0.25, 0.5, 1.0, 1.0 + 5e-10, 1.0 + 2e-9, 2.0)
GRANTED = 1 + Fraction(EXACT_WIDTH)


def some_finding(dice: random.Random) -> Finding:
    relation = dice.choice([r for r in RELATIONS if r != "indeterminate"])
    bounds = [tuple(sorted(dice.choices(LENGTHS, k=2))) if dice.random() < 0.8 else None] * 2
    volume = dice.choice((None, *LENGTHS))
    return Finding(
        id="0" * 12,
        a="a",
        b="b",
        severity="none",
        relation=relation,
        depth_bounds=bounds[0] if relation in OVERLAPS else None,
        thickness_bounds=bounds[1] if relation in OVERLAPS else None,
        volume=volume,
        volume_error=None if volume is None else dice.choice((0.0, 0.125)),
        plan=(),
    )


def some_request(dice: random.Random) -> Request:
    values = {key: dice.choice(LENGTHS) for key in LIMITS if dice.random() < 0.3}
    if not values and dice.random() < 0.7:
        values["clearance"] = dice.choice(LENGTHS)
    severity = dice.choice((None, None, "error", "warning", "note", "none"))
    rules = {key: f"rule {k % 2}" for k, key in enumerate(values) if key in LIMITS or k % 2}
    return Request(**values, severity=severity, rules=rules | {"severity": "rule 2"})


def expected(
    finding: Finding, request: Request, gap: tuple[float, float]
) -> tuple[str, str | None, str | None]:
    """Return the severity, the rule and what is undecided."""
    verdict = _expected_by_default(finding, request, *map(Fraction, gap))
    if verdict[0] == "error" and request.severity:
        return "silenced" if request.severity == "none" else request.severity, "rule 2", verdict[2]
    return verdict


def _expected_by_default(
    finding: Finding, request: Request, least: Fraction, most: Fraction
) -> tuple[str, str | None, str | None]:
    limits = {key: getattr(request, key) for key in LIMITS if getattr(request, key) is not None}
    if finding.relation in OVERLAPS:
        kept = {key: _is_kept(finding, key, Fraction(limit)) for key, limit in limits.items()}
        for state, severity, undecided in ((False, "error", None), (None, "warning", "limit")):
            for key, value in kept.items():
                if value is state:
                    return severity, request.rules[key], undecided
        names = ", ".join(dict.fromkeys(request.rules[key] for key in kept))
        return ("note", names, None) if kept else ("error", None, None)
    rule = request.rules.get("clearance", "clearance")
    if finding.relation == "near":
        return "error", rule, None
    clearance = Fraction(request.clearance or 0)
    if most < clearance:
        return "error", rule, None
    if clearance and least < clearance * (1 - Fraction(EXACT_WIDTH)):
        return "warning", rule, "limit"
    return "note" if finding.relation == "touching" else "none", None, None


def _is_kept(finding: Finding, key: str, limit: Fraction) -> bool | None:
    if key == "max_volume":
        if finding.volume is None:
            return None
        error = Fraction(finding.volume_error or 0)
        least, greatest = Fraction(finding.volume) - error, Fraction(finding.volume) + error
    else:
        bounds = finding.depth_bounds if key == "max_depth" else finding.thickness_bounds
        if bounds is None:
            return None
        least, greatest = map(Fraction, bounds)
    if greatest <= limit * GRANTED:
        return True
    return False if least > limit else None


@pytest.mark.parametrize("seed", range(50))
def test_random_findings_are_judged_as_in_rational_numbers(seed: int) -> None:
    dice = random.Random(seed)
    for _ in range(40):
        finding, request = some_finding(dice), some_request(dice)
        low, high = sorted(dice.choices(LENGTHS, k=2))
        found = judged(finding, request, (low, high))
        assert (found.severity, found.rule, found.undecided) == expected(
            finding, request, (low, high)
        )
        assert (found.reason is None) == (found.undecided is None)
        doubted = disputed(found, "why")
        assert RANKS.index(doubted.severity) == max(RANKS.index(found.severity), 3)
        assert doubted.undecided == (found.undecided or "cross-check")


@pytest.mark.parametrize("seed", range(50))
def test_random_reports_have_the_summary_that_follows(seed: int) -> None:
    dice = random.Random(seed)
    findings = [_judged_at_random(dice) for _ in range(dice.randrange(5))]
    left_open, pruned, allowed = (dice.choice((0, 0, 3)) for _ in range(3))
    relations = Counter(str(finding.relation) for finding in findings)
    indeterminate = left_open + relations["indeterminate"]
    decided = len(findings) - relations["indeterminate"]
    total = pruned + decided + allowed + indeterminate
    counts = PairCounts(total, pruned, decided, allowed, indeterminate)
    answer = SupportFinding("a", "stable", "r", dice.choice(RANKS), dice.choice(("yes", "open")))
    answers = [answer] if dice.random() < 0.3 else []
    blocking = Issue("unread", "warning", None, None, "", state="blocking")
    issues = [blocking] if dice.random() < 0.3 else []
    fail_on, alone = dice.choice(RANKS[2:]), dice.random() < 0.5
    body = BodyReport(id="a", name="a", file="a.obj", groups=(), static=False, triangles=12)
    report = Report(
        tool=Tool("satcheck", ""),
        units=None,
        settings=StatedSettings(fail_on=fail_on),
        summary=Summary("incomplete", counts, {}),
        pose={},
        bodies=(body,) if alone else (body, body),
        findings=tuple(findings),
        issues=tuple(issues),
        statics=_statics(*answers),
    )
    made = summarise(report)
    relations["separated"] += pruned
    relations["indeterminate"] += left_open
    assert Counter({str(key): n for key, n in made.by_relation.items()}) == relations
    graves = [f for f in findings if RANKS.index(f.severity) >= RANKS.index(fail_on)]
    decided_graves = [f for f in graves if f.severity == "error" or f.undecided is None]
    assert [f for f in findings if fails(f, fail_on)] == decided_graves
    unmet = [
        a for a in answers if a.answer != "open" and a.severity in RANKS[RANKS.index(fail_on) :]
    ]
    is_open = left_open or issues
    is_open = is_open or any(f.undecided and f.baseline_state != "accepted" for f in findings)
    is_open = is_open or any(a.answer == "open" for a in answers)
    nothing = total == allowed and not alone
    fail = unmet or any(f.baseline_state not in HELD for f in decided_graves)
    assert made.verdict == ("fail" if fail else "incomplete" if is_open or nothing else "pass")
    assert made.limits_undecided == sum(f.undecided == "limit" for f in findings)
    assert made.accepted == sum(f.baseline_state in HELD for f in findings)


def _judged_at_random(dice: random.Random) -> Finding:
    relation = dice.choice(RELATIONS)
    undecided = "relation" if relation == "indeterminate" else dice.choice((None, None, "limit"))
    return Finding(
        id="0" * 12,
        a="a",
        b="b",
        severity=dice.choice(RANKS),
        relation=relation,
        undecided=undecided,
        baseline_state=dice.choice((None, *HELD, "new")),
        plan=(),
    )


def _statics(*answers: SupportFinding) -> Statics:
    return Statics(
        gravity=(0.0, 0.0, -1.0),
        friction=0.5,
        tolerance=0.0,
        stated=(),
        asked_by=(),
        rules=(),
        bodies=(),
        contacts=(),
        islands=(),
        findings=answers,
        pairs=0,
    )
