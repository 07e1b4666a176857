"""What the body rules of a report say about each body, and the answers to them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from satcheck.report.report import BodyAnswer
from satcheck.report.statics import BodyRuleReport
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


def checked(finding: BodyAnswer, check: Callable[[], None]) -> CheckedSupport:
    """Return what a check says of an answer."""
    outcome: Outcome = "accepted"
    reason = None
    try:
        check()
    except NotCertified as why:
        outcome, reason = "not certified", str(why)
    except Rejected as why:
        outcome, reason = "rejected", str(why)
    else:
        if finding.answer == "open":
            outcome, reason = "open", finding.reason
    return CheckedSupport(finding.body, finding.question, finding.answer, outcome, reason)
