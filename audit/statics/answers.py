"""Answers to questions about one body, and the parts of a report that state them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from satcheck.audit.statics.islands import Graph, Outcome
from satcheck.audit.statics.margins import MOST_OF_STEP
from satcheck.report.regions import InsideFinding
from satcheck.report.report import Issue
from satcheck.report.statics import (
    BodyRuleReport,
    Question,
    State,
    SupportFinding,
)
from satcheck.report.verdict import severity_of_answer
from satcheck.scene.statics import KEYS, QUESTIONS, BodyRule, BodyTerms

if TYPE_CHECKING:
    from satcheck.audit.statics.near import Floats
    from satcheck.report.values import Vector

NO_CHAIN = "it floats: no chain of contacts leads to a fixed body"
NOT_LET_GO = "squeeze not looked for: its island has too many contact points"
NOT_DECIDED = "squeeze not decided: the search for the first motion did not end"
FALLS = "no contact forces hold it: it starts to move"


def answer_to(
    question: Question, k: int, graph: Graph, outcome: Outcome | None
) -> tuple[State, str | None]:
    """The answer, and the reason if it is not yes, or why the body may fall although forces exist
    that hold it. outcome: of its island; None: it is fixed."""
    if outcome is None:
        return "yes", None
    stated = outcome.stated
    if graph.floating[k] == "yes":
        return "no", NO_CHAIN
    if stated.tolerant == "no":
        if k in outcome.motions:
            return "no", FALLS
        return "open", "it is in contact with bodies that start to move"
    if graph.floating[k] == "open":
        return "open", stated.reason or "whether a chain of contacts holds it is not decided"
    if (stated.tolerant if question == "supported" else stated.strict) != "yes":
        return "open", stated.reason
    if stated.squeezed:
        return "yes", "squeeze only: forces hold it if something presses it, else it falls"
    if stated.balanced:
        return "yes", "balanced: any tilt of gravity moves it"
    if stated.squeezed is None and outcome.beside_walls:
        is_large = outcome.standing is not None and len(outcome.standing.at) > MOST_OF_STEP
        return "open" if question == "stable" else "yes", NOT_LET_GO if is_large else NOT_DECIDED
    return "yes", None


def finding(
    body: str,
    question: Question,
    rule: BodyRule,
    terms: BodyTerms,
    answer: State,
    reason: str | None,
) -> SupportFinding:
    """reason: of a yes, a doubt, which is a warning. terms: of the body."""
    level = severity_of_answer(answer, terms.value("severity"))
    if answer == "yes" and reason is not None:
        level = "warning"
    return SupportFinding(body, question, rule.name, level, answer, reason)


def issues_of(
    findings: Iterable[SupportFinding | InsideFinding], failed: str, undecided: str
) -> list[Issue]:
    """Bodies that fail or are open, once each, for formats that only list pairs and issues. failed,
    undecided: the codes."""
    issues: dict[str, Issue] = {}
    for answer in sorted(findings, key=lambda f: f.answer):  # no before open
        if answer.answer != "yes":
            code, said = (failed, "not") if answer.answer == "no" else (undecided, "perhaps not")
            message = f"{answer.body} is {said} {answer.question}: {answer.reason}"
            issues.setdefault(answer.body, Issue(code, "warning", answer.body, None, message))
    return list(issues.values())


def rule_report(rule: BodyRule) -> BodyRuleReport:
    values = {key: getattr(rule, key) for key in (*KEYS, "reason", "where")}
    return BodyRuleReport(bodies=rule.bodies.text, **values)


def vector(values: Floats) -> Vector:
    x, y, z = values.tolist()
    return x, y, z


def asked_of(terms: BodyTerms) -> list[tuple[Question, BodyRule]]:
    """The questions about a body, with the rule that asks each."""
    rules = ((question, terms.asks(question)) for question in QUESTIONS)
    return [(question, rule) for question, rule in rules if rule is not None]
