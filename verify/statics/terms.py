"""What the body rules of a report say about each body, and the answers to them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from satcheck.report.report import BodyAnswer
from satcheck.report.statics import BodyRuleReport, Statics
from satcheck.report.verification import CheckedSupport, Outcome
from satcheck.scene.rules import Selector
from satcheck.scene.statics import KEYS, QUESTIONS, BodyRule, BodyTerms, terms_of
from satcheck.verify.bodies import Placed
from satcheck.verify.exact import NotCertified, Rejected
from satcheck.verify.statics.weights import Weight, weight_of


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


class Terms:
    """statics: of the report. bodies: of the report, by id."""

    def __init__(self, statics: Statics, bodies: Mapping[str, Placed]) -> None:
        self._friction, self._bodies = statics.friction, bodies
        self._terms = body_terms(statics.rules, bodies)

    def value(self, id_: str, key: str) -> Any:
        """Of the last rule that sets the key; None: none does."""
        return self._terms[id_].value(key)

    def rule(self, id_: str, key: str) -> str | None:
        """The name of that rule."""
        rule = self._terms[id_].rules.get(key)
        return None if rule is None else rule.name

    def asked(self) -> Iterator[tuple[str, str]]:
        """Each body with each question about it."""
        for id_, terms in self._terms.items():
            for question in QUESTIONS:
                if terms.asks(question):
                    yield id_, question

    def friction(self, a: str, b: str) -> float:
        """Of a contact: the smaller one of both bodies."""
        own = [self.value(name, "friction") for name in (a, b)]
        return min([value for value in own if value is not None], default=self._friction)

    def weight(self, id_: str) -> Weight:
        """Rejects a body without a known volume."""
        return weight_of(self._bodies[id_], self.value(id_, "mass"), self.value(id_, "density"))
