"""What the body rules of a report say about each body, and the answers to them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from satcheck.report.report import BodyAnswer
from satcheck.report.statics import BodyRuleReport
from satcheck.report.verdict import severity_of_answer
from satcheck.report.verification import CheckedSupport, Outcome
from satcheck.scene.rules import Selector
from satcheck.scene.statics import KEYS, BodyRule, BodyTerms, terms_of
from satcheck.verify.bodies import Placed
from satcheck.verify.exact import NotCertified, Rejected


def body_terms(
    rules: Sequence[BodyRuleReport], bodies: Mapping[str, Placed]
) -> dict[str, BodyTerms]:
    """Return what the rules say about each body of the report, by id."""
    of_scene = [
        BodyRule(
            bodies=Selector(rule.bodies),
            **{key: getattr(rule, key) for key in (*KEYS, "reason", "where")},
        )
        for rule in rules
    ]
    return dict(zip(bodies, terms_of(list(bodies.values()), of_scene), strict=True))


def once(check: Callable[..., None]) -> Callable[..., None]:
    """A check that several answers share: for each of its arguments it is made once."""
    results: dict[tuple[Any, ...], Rejected | NotCertified | None] = {}

    def again(*of: Any) -> None:
        if of not in results:
            try:
                results[of] = check(*of)  # type: ignore[func-returns-value]
            except (Rejected, NotCertified) as why:
                results[of] = why
        refusal = results[of]
        if refusal is not None:
            raise type(refusal)(str(refusal))

    return again


def checked(
    finding: BodyAnswer,
    key: str,
    own: BodyTerms,
    check: Callable[[], None],
    is_doubted: Callable[[], bool] = lambda: False,
) -> CheckedSupport:
    """Return what a check says of an answer. key: of the rules that ask. own: what the rules say
    about the body. is_doubted: whether the answer comes with a warning that does not follow from
    them."""
    outcome: Outcome = "open" if finding.answer == "open" else "accepted"
    reason = finding.reason if outcome == "open" else None
    try:
        if finding.rule != own.rules[key].name:
            raise Rejected("another rule asks this")
        follows = severity_of_answer(finding.answer, own.value("severity"))
        if not is_doubted() and finding.severity != follows:
            raise Rejected("the severity does not follow from the answer and the rules")
        check()
    except NotCertified as why:
        outcome, reason = "not certified", str(why)
    except Rejected as why:
        outcome, reason = "rejected", str(why)
    return CheckedSupport(finding.body, finding.question, finding.answer, outcome, reason)
