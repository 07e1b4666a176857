"""What rules say about pairs, held against going through all of them."""

from __future__ import annotations

import random
from fnmatch import fnmatchcase
from itertools import combinations

import pytest

from satcheck.audit.bodies import book_of
from satcheck.report.rule_book import RuleBook
from satcheck.scene import Rule, Selector
from tests.report.books import Subject

SELECTORS = ["*", "a*", "b?", "a1", "b2", "[ab]3", "nobody", "group:g", "group:h", "group:*"]


def rule(a: str, b: str, **keys) -> Rule:
    return Rule(a=Selector(a), b=Selector(b), **keys)


def allows(book: RuleBook, i: int, j: int) -> bool:
    rule = book.terms(i, j).get("allowed")
    return rule is not None and rule.allowed is True


def chosen(text: str, body: Subject) -> bool:
    if text.startswith("group:"):
        return any(fnmatchcase(group, text[6:]) for group in body.groups)
    return fnmatchcase(body.id, text)


def is_about(one: Rule, p: Subject, q: Subject) -> bool:
    a, b = one.a.text, one.b.text
    return (chosen(a, p) and chosen(b, q)) or (chosen(a, q) and chosen(b, p))


def subjects(seed: int, count: int = 14) -> list[Subject]:
    dice = random.Random(seed)
    return [
        Subject(
            f"{'ab'[k % 2]}{k // 2}",
            tuple(dice.sample("ghi", dice.randrange(4))),
            dice.random() < 0.4,
        )
        for k in range(count)
    ]


def random_rules(seed: int) -> list[Rule]:
    dice = random.Random(-seed - 1)
    found = []
    for _ in range(dice.randrange(7)):
        if dice.random() < 0.6:
            keys = {"allowed": dice.random() < 0.6}
        else:
            keys = {dice.choice(["max_depth", "clearance", "tolerance"]): dice.random()}
        found.append(rule(dice.choice(SELECTORS), dice.choice(SELECTORS), **keys))
    return found


@pytest.mark.parametrize("seed", range(40))
def test_as_if_every_pair_were_gone_through(seed: int) -> None:
    bodies, rules = subjects(seed), random_rules(seed)
    ignored, check_static = frozenset("gi" if seed % 2 else ""), seed % 3 == 0
    book = book_of(bodies, rules, ignored, check_static)
    total = allowed = 0
    for i, j in combinations(range(len(bodies)), 2):
        p, q = bodies[i], bodies[j]
        skipped = bool(ignored & set(p.groups) & set(q.groups)) or (
            p.static and q.static and not check_static
        )
        assert book.is_ignored(i, j) == book.is_ignored(j, i) == skipped
        deciding = {}
        for one, stated in zip(rules, book.rules, strict=True):
            if is_about(one, p, q):
                for key in ("allowed", "max_depth", "clearance", "tolerance"):
                    if getattr(one, key) is not None:
                        deciding[key] = stated
        for terms in (book.terms(i, j), book.terms(j, i)):
            assert terms.get("allowed") is deciding.get("allowed")
            assert terms.get("max_depth") is deciding.get("max_depth")
            assert terms.get("clearance") is deciding.get("clearance")
            assert terms.get("tolerance") is deciding.get("tolerance")
        for one in deciding.values():
            assert book.longest("clearance")[i] >= (one.clearance or 0.0)
        total += not skipped
        asked = not skipped and not allows(book, i, j)
        assert book.is_checked(i, j) == asked
        allowed += not skipped and not asked
        kinds = tuple(sorted((book.kind_of[i], book.kind_of[j])))
        assert not (asked and ((i, j) in book.exempt_named() or kinds in book.exempt_kinds()))
    assert book.count() == (total, allowed)
    some = range(0, len(bodies), 2)
    among = [(i, j) for i, j in combinations(some, 2) if not book.is_ignored(i, j)]
    assert book.count(some) == (len(among), sum(allows(book, i, j) for i, j in among))
    unused = [
        number
        for number, one in enumerate(rules)
        if not any(is_about(one, p, q) for p, q in combinations(bodies, 2))
    ]
    assert list(book.unused()) == unused


def test_an_id_with_brackets_is_matched_by_its_own_name() -> None:
    bodies = [Subject(name) for name in ("br0", "br1", "br[0]", "br[1]")]
    book = book_of(bodies, [rule("br[0]", "br[1]", allowed=True)])
    assert not allows(book, 0, 1)
    assert allows(book, 2, 3)
    assert book.count() == (6, 1)


def test_the_last_rule_that_sets_a_key_decides_it() -> None:
    first, second = rule("*", "*", clearance=1.0, max_volume=2.0), rule("a", "*", max_volume=1.0)
    book = book_of([Subject("a"), Subject("b"), Subject("c")], [first, second])
    assert book.terms(0, 1)["clearance"] is book.rules[0]
    assert book.terms(0, 1)["max_volume"] is book.rules[1]
    assert book.terms(1, 2)["max_volume"] is book.rules[0]


def test_a_later_rule_takes_a_permission_back() -> None:
    book = book_of(
        [Subject("a"), Subject("b"), Subject("c")],
        [rule("*", "*", allowed=True), rule("b", "c", allowed=False)],
    )
    assert allows(book, 0, 1)
    assert not allows(book, 2, 1)
    assert book.count() == (3, 2)


def test_one_rule_is_about_no_body_and_itself() -> None:
    book = book_of([Subject("a"), Subject("b")], [rule("a", "a", allowed=True)])
    assert list(book.unused()) == [0]
    assert book.terms(0, 1) == {}


def test_ten_thousand_bodies_are_counted_without_their_pairs() -> None:
    """Fifty million pairs: to go through them would take minutes."""
    count = 10_000
    bodies = [Subject(f"bolt-{k}" if k % 2 else f"plate-{k}") for k in range(count)]
    named = [rule(f"plate-{k}", f"bolt-{k + 1}", allowed=True) for k in range(0, count, 2)]
    book = book_of(bodies, [*named, rule("bolt-*", "bolt-*", allowed=True)])
    bolts = count // 2
    assert book.count() == (count * (count - 1) // 2, bolts * (bolts - 1) // 2 + bolts)
