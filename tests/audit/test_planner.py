"""What flags and rules ask of a pair, and who asked."""

from __future__ import annotations

import pytest

from satcheck.audit.bodies import book_of
from satcheck.audit.planner import ALWAYS, FOR_MESHES, Planner, request_for
from satcheck.audit.settings import Settings
from satcheck.report.rule_book import Terms
from satcheck.scene import Rule, Selector
from tests.report.books import Subject


def rule(a: str = "*", b: str = "*", **keys) -> Rule:
    return Rule(a=Selector(a), b=Selector(b), **keys)


def terms(**keys) -> Terms:
    """Each key by a rule of its own, named after it."""
    return {key: rule(where=key, **{key: value}) for key, value in keys.items()}


def test_only_the_overlap_is_a_matter_of_course_in_a_scene() -> None:
    assert request_for(Settings(), composed=True).by == {"overlap": ALWAYS}


def test_the_depth_of_mesh_files_is_asked_by_default() -> None:
    assert request_for(Settings()).by == {
        "overlap": ALWAYS,
        "depth": FOR_MESHES,
        "thickness": FOR_MESHES,
    }
    assert request_for(Settings(depth=False)).by == {"overlap": ALWAYS}
    assert not request_for(Settings(thickness=False)).wants("thickness")


@pytest.mark.parametrize(
    ("settings", "effect", "flag"),
    [
        ({"depth": True, "thickness": False}, "depth", "--depth"),
        ({"clearance": 1.0}, "distance", "--clearance"),
        ({"volume": True}, "volume", "--volume"),
        ({"contacts": True}, "contacts", "--contacts"),
        ({"cross_check": True}, "cross-check", "--cross-check"),
        ({"certificate": True}, "certificate", "--certificate"),
    ],
)
def test_a_flag_asks_for_its_effect_alone(settings, effect, flag) -> None:
    asked = request_for(Settings(**settings), composed=True)
    assert asked.by == {"overlap": ALWAYS, effect: flag}


def test_the_flag_of_the_depth_asks_for_the_thickness_too() -> None:
    asked = request_for(Settings(depth=True), composed=True)
    assert asked.by == {"overlap": ALWAYS, "depth": "--depth", "thickness": "--depth"}


@pytest.mark.parametrize(
    ("keys", "effect"),
    [
        ({"max_depth": 0.1}, "depth"),
        ({"max_thickness": 0.1}, "thickness"),
        ({"max_volume": 0.1}, "volume"),
        ({"clearance": 1}, "distance"),
    ],
)
def test_a_rule_asks_for_what_it_needs(keys, effect) -> None:
    asked = request_for(Settings(), terms(**keys), composed=True)
    assert asked.by == {"overlap": ALWAYS, effect: next(iter(keys))}


def test_a_depth_rule_asks_whatever_the_flags_say() -> None:
    assert request_for(Settings(depth=False), terms(max_depth=0.1)).wants("depth")


def test_a_rule_stands_above_the_flags() -> None:
    settings = Settings(clearance=1.0, tolerance=0.1)
    asked = request_for(settings, terms(clearance=2.0, tolerance=0.2, severity="warning"))
    assert (asked.clearance, asked.tolerance, asked.severity) == (2.0, 0.2, "warning")
    assert asked.rule("severity") == "severity"
    assert request_for(settings).rule("severity") is None


def test_a_clearance_of_nothing_is_none() -> None:
    asked = request_for(Settings(clearance=1.0), terms(clearance=0.0))
    assert asked.clearance is None
    assert not asked.wants("distance")


@pytest.mark.parametrize("limit", ["max_depth", "max_thickness", "max_volume"])
def test_what_may_overlap_keeps_no_clearance(limit) -> None:
    asked = request_for(Settings(clearance=1.0), terms(clearance=2.0, **{limit: 0.1}))
    assert asked.limited
    assert not asked.wants("distance")
    assert asked.clearance is None


def test_pairs_of_one_kind_share_what_is_asked() -> None:
    book = book_of([Subject(f"b{k}") for k in range(4)], [rule("b0", "b*", max_depth=1.0)])
    planner = Planner(Settings(), book, composed=True)
    assert planner.request(0, 1) is planner.request(0, 3)
    assert planner.request(0, 1).wants("depth")
    assert not planner.request(1, 2).wants("depth")
    assert not planner.stated().depth


def test_no_pair_is_asked_further_than_its_reach() -> None:
    rules = [
        rule("b0", "b1", clearance=4.0),
        rule("b1", "b2", tolerance=6.0),
        rule("b1", "b*", clearance=1.0),
    ]
    book = book_of([Subject(f"b{k}") for k in range(4)], rules)
    for settings in (Settings(), Settings(clearance=3.0), Settings(tolerance=0.5)):
        planner = Planner(settings, book)
        resolution = [0.1, 0.2, 0.3, 0.4]
        reach = planner.reach(dict(enumerate(resolution)))
        for i in range(4):
            for j in range(i):
                gap = planner.gap_limit(i, j, resolution[i] + resolution[j])
                assert gap <= reach[i] + reach[j] + 1e-15
    assert Planner(Settings(), book).gap_limit(0, 1, 0.3) == 1.0  # the last rule decides


@pytest.mark.parametrize(
    ("effect", "key"),
    [("depth", "max_depth"), ("thickness", "max_thickness"), ("volume", "max_volume")],
)
def test_a_limit_of_nothing_asks_too(effect: str, key: str) -> None:
    """A clearance of 0 is none, but an overlap that must have no depth has one to be measured."""
    none = rule(where="none", clearance=0.0)
    book = book_of([Subject("a"), Subject("b")], [rule(where="zero", **{key: 0.0}), none])
    planner = Planner(Settings(), book, composed=True)
    assert planner.request(0, 1).by[effect] == "zero"
    assert planner.requested_by(effect) == ("zero",)
    assert planner.requested_by("distance") == ()
