"""What the body rules of a report say about each body."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from satcheck.report.statics import Statics
from satcheck.verify.bodies import Placed
from satcheck.verify.rules import selected_by
from satcheck.verify.statics.weights import Weight, weight_of

QUESTIONS = ("supported", "stable")
KEYS = (*QUESTIONS, "mounted", "region", "density", "mass", "friction", "severity")


class Terms:
    """statics: of the report. bodies: of the report, by id."""

    def __init__(self, statics: Statics, bodies: Mapping[str, Placed]) -> None:
        self._friction, self._bodies = statics.friction, bodies
        self._values: dict[str, dict[str, Any]] = {id_: {} for id_ in bodies}
        self._rules: dict[str, dict[str, str]] = {id_: {} for id_ in bodies}
        select = selected_by(bodies)
        for rule in statics.rules:
            values = {key: getattr(rule, key) for key in KEYS}
            known = {key: value for key, value in values.items() if value is not None}
            for id_ in select(rule.bodies):
                self._values[id_] |= known
                self._rules[id_] |= dict.fromkeys(known, rule.where or rule.bodies)

    def value(self, id_: str, key: str) -> Any:
        """Of the last rule that sets the key; None: none does."""
        return self._values[id_].get(key)

    def rule(self, id_: str, key: str) -> str | None:
        """The name of that rule."""
        return self._rules[id_].get(key)

    def asked(self) -> Iterator[tuple[str, str]]:
        """Each body with each question about it."""
        for id_ in self._bodies:
            for question in QUESTIONS:
                if self.value(id_, question):
                    yield id_, question

    def friction(self, a: str, b: str) -> float:
        """Of a contact: the smaller one of both bodies."""
        own = [self.value(name, "friction") for name in (a, b)]
        return min([value for value in own if value is not None], default=self._friction)

    def weight(self, id_: str) -> Weight:
        """Rejects a body without a known volume."""
        return weight_of(self._bodies[id_], self.value(id_, "mass"), self.value(id_, "density"))
