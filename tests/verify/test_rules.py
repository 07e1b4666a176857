"""The rules of a report, evaluated again: true reports stand, and no rule can be bent."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import combinations
from typing import Any

import pytest
from msgspec.structs import replace

from satcheck.audit import Settings, check
from satcheck.audit.bodies import book_of
from satcheck.core.shapes import Box
from satcheck.report.report import Exempt
from satcheck.scene import Body, Rule, Scene, Selector
from satcheck.scene.inspect import shape_file
from satcheck.verify import Rejected
from satcheck.verify.bodies import Placed
from satcheck.verify.document import rule_book
from tests.cli.process import VALIDATOR
from tests.report.books import Subject
from tests.report.test_rule_book import random_rules, subjects
from tests.verify.reports import Json, is_accepted, verified

SHAPE = Box((1.0, 1.0, 1.0))
FILE = shape_file(SHAPE, "cell.toml")


def rule(a: str = "*", b: str = "*", **keys: Any) -> Rule:
    return Rule(a=Selector(a), b=Selector(b), where="cell.toml:3", **keys)


def at(x: float) -> tuple[float, ...]:
    return (1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def scene(*rules: Rule, xs: tuple[float, ...] = (0.0, 0.75), **changes: Any) -> Scene:
    bodies = tuple(Body(f"b{k}", "", FILE, transform=at(x), shape=SHAPE) for k, x in enumerate(xs))
    return replace(Scene("", None, bodies), rules=rules, **changes)


def report(*rules: Rule, settings: Settings | None = None, **changes: Any) -> Json:
    asked = replace(settings or Settings(), certificate=True)
    made: Json = json.loads(json.dumps(check(scene(*rules, **changes), asked).to_dict()))
    VALIDATOR.validate(made)
    return made


REPORTS: dict[str, Callable[[], Json]] = {
    "no rule": report,
    "allowed": lambda: report(rule(allowed=True)),
    "allowed, and taken back": lambda: report(rule(allowed=True), rule(allowed=False)),
    "within its depth": lambda: report(rule(max_depth=0.25)),
    "too deep": lambda: report(rule(max_depth=0.125)),
    "too much": lambda: report(rule(max_volume=0.125)),
    "called a warning": lambda: report(rule(severity="warning")),
    "called nothing": lambda: report(rule(severity="none"), settings=Settings(fail_on="note")),
    "a note that fails": lambda: report(rule(severity="note"), settings=Settings(fail_on="note")),
    "too deep, and a note": lambda: report(rule(max_depth=0.125), rule(severity="note")),
    "within the tolerance": lambda: report(rule(tolerance=0.5)),
    "near": lambda: report(rule(clearance=1.0), xs=(0.0, 1.5)),
    "near enough": lambda: report(rule(clearance=0.25), xs=(0.0, 1.5)),
    "free of a clearance": lambda: report(
        rule("b0", clearance=0.0), xs=(0.0, 1.5), settings=Settings(clearance=1.0)
    ),
    "limited instead": lambda: report(
        rule("b0", max_depth=0.1), xs=(0.0, 1.5), settings=Settings(clearance=1.0)
    ),
    "pruned pair by pair": lambda: report(
        rule("b0", "b2", clearance=4.0), xs=(0.0, 2.0, 4.0), settings=Settings(list_pruned=False)
    ),
}


@pytest.mark.parametrize("name", REPORTS)
def test_a_true_report_is_accepted(name: str) -> None:
    found = verified(REPORTS[name]())
    assert found.accepted, (found.faults, [one.reason for one in found.findings])


def test_a_volume_within_its_limit_is_not_certified() -> None:
    """It is measured in float64, and no certificate proves it."""
    document = report(rule(max_volume=0.5))
    assert document["findings"][0]["severity"] == "note"
    assert [one.outcome for one in verified(document).findings] == ["not certified"]


def test_pairs_of_static_bodies() -> None:
    still = scene(xs=(0.0, 0.75, 0.5))
    bodies = (*(replace(body, static=True) for body in still.bodies[:2]), still.bodies[2])
    made = check(replace(still, bodies=bodies, check_static=False), Settings(certificate=True))
    document: Json = json.loads(json.dumps(made.to_dict()))
    assert document["summary"]["pairs"]["total"] == 2
    assert verified(document).accepted
    document["exempt"]["static_pairs"] = False
    assert not verified(document).accepted


ALLOWED: Json = {
    **dict.fromkeys(("max_depth", "max_volume", "clearance", "tolerance", "severity")),
    **{"a": "*", "b": "*", "allowed": True, "reason": "", "where": "cell.toml:4"},
}
FORGED: dict[str, tuple[str, Callable[[Json], Any]]] = {
    "a limit raised": ("too deep", lambda d: d["rules"][0].update(max_depth=1.0)),
    "a limit lowered": ("within its depth", lambda d: d["rules"][0].update(max_depth=0.125)),
    "a permission": ("no rule", lambda d: d["rules"].append(ALLOWED)),
    "a permission gone": ("allowed", lambda d: d["rules"].clear()),
    "a permission for others": ("allowed", lambda d: d["rules"][0].update(a="x")),
    "the order": ("allowed, and taken back", lambda d: d["rules"].reverse()),
    "a severity": ("called a warning", lambda d: d["findings"][0].update(severity="none")),
    "a severity of a rule": ("called a warning", lambda d: d["rules"][0].update(severity=None)),
    "no pass of nothing": ("allowed", lambda d: d["summary"].update(verdict="incomplete")),
    "a pass by a choice": ("allowed", lambda d: d["rules"][0].update(where="--between")),
    "what fails": ("called a warning", lambda d: d["settings"].update(fail_on="warning")),
    "undecided": ("too deep", lambda d: d["findings"][0].update(undecided="limit")),
    "a tolerance": ("within the tolerance", lambda d: d["rules"][0].update(tolerance=0.125)),
    "a clearance": ("near enough", lambda d: d["rules"][0].update(clearance=1.0)),
}


@pytest.mark.parametrize("name", FORGED)
def test_a_bent_rule_is_found(name: str) -> None:
    kind, forge = FORGED[name]
    document = REPORTS[kind]()
    assert verified(document).accepted
    forge(document)
    assert not is_accepted(document)


def test_an_overlap_is_not_within_its_limit_because_it_says_so() -> None:
    document = report(rule(max_depth=0.125))
    document["findings"][0].update(severity="note")
    document["summary"].update(verdict="pass")
    assert [one.outcome for one in verified(document).findings] == ["rejected"]


@pytest.mark.parametrize(
    "change",
    [{"a": ""}, {"b": "group:"}, {"a": None}, {"max_depth": -1}, {"tolerance": "x"},
     {"clearance": True}, {"severity": "fatal"}, {"allowed": "yes"}],
)  # fmt: skip
def test_a_rule_that_is_none_makes_it_no_report(change: Json) -> None:
    document = report(rule(max_depth=1.0))
    document["rules"][0].update(change)
    with pytest.raises(Rejected):
        verified(document)


@pytest.mark.parametrize("seed", range(20))
def test_the_rules_of_the_report_are_those_of_the_scene(seed: int) -> None:
    rules, bodies = random_rules(seed), subjects(seed)
    book = book_of(bodies, rules, frozenset("gh"), check_static=False)
    found = rule_book(Exempt(("g", "h"), True), book.rules, list(map(_placed, bodies)))
    for i, j in combinations(range(len(bodies)), 2):
        assert found.is_checked(i, j) == book.is_checked(i, j)
        assert found.terms(i, j) == book.terms(i, j)
    assert found.count() == book.count()


NAMES = ("br0", "br[0]", "br[[]0]", "a*", "a[*]", "ab", "group:x", "[g]roup:x", "x")
TEXTS = (*NAMES, "[a]b", "br?", "[b]r[0]", "*x", "[!a]*")


@pytest.mark.parametrize("text", [*TEXTS, *(f"group:{text}" for text in TEXTS)])
def test_brackets_read_the_same_as_by_the_solver(text: str) -> None:
    bodies = [Subject(name, (name,)) for name in NAMES]
    book = book_of(bodies, [rule(text, "*", allowed=True)])
    found = rule_book(Exempt(), book.rules, list(map(_placed, bodies)))
    for i, j in combinations(range(len(bodies)), 2):
        assert found.is_checked(i, j) == book.is_checked(i, j)
    assert book.count()[1] > 0


def _placed(body: Subject) -> Placed:
    return Placed(body.id, frozenset(body.groups), None, static=body.static)
