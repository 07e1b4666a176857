"""For each field of the published schema false claims, made from honest reports of many kinds.

Each is rejected, or the field is one that the checker names as not covered. No field is left out:
one that no honest report here says anything in would go untested.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from itertools import takewhile
from typing import Any

import pytest
from msgspec import to_builtins

from satcheck.report.contacts import Component, Components
from satcheck.verify import Rejected, VerificationReport
from satcheck.verify.coverage import COVERAGE
from tests.verify.honest import HONEST, honest
from tests.verify.reports import Json, verified
from tests.verify.test_coverage import FIELDS, speaks_of

Place = tuple[str | int, ...]
WORDS = {
    "relation": ("separated", "near", "touching", "penetrating", "contains", "inside"),
    "exact_relation": ("separated", "touching", "penetrating", "contains", "inside"),
    "severity": ("error", "warning", "note", "silenced", "none"),
    "quality": ("exact", "bounded", "estimate"),
    "undecided": ("relation", "inside", "limit", "motion", "cross-check"),
    "verdict": ("pass", "fail", "incomplete"),
    "mtv_moves": ("b",),
    "file": ("elsewhere.toml",),
    "answer": ("yes", "no", "open"),
    "question": ("supported", "stable"),
    "fixed": ("static", "mounted"),
    "touch": ("touching", "overlapping", "unknown"),
    "tolerant": ("yes", "no", "open"),
    "strict": ("yes", "no", "open"),
    "floating": ("yes", "no", "open"),
}
# What of a large scene is forged once more.
JUDGED = ("severity", "undecided", "rule", "relation", "verdict", "findings")
# Forged are so many members of each list but that of the bodies.
MEMBERS = 2
PLAUSIBLE = (0.25, 1, True, "x", [0.25, 0.5], [0.0, 0.0, 1.0], {"a": [0, 0, 0], "b": [0, 0, 0]})


def places(value: Any, path: Place = ()) -> Iterator[Place]:
    """Of every value of a report, but within certificates, which claim nothing."""
    if path:
        yield path
    if path and path[-1] == "certificate":
        return
    if isinstance(value, dict):
        for key, member in value.items():
            yield from places(member, (*path, key))
    elif isinstance(value, list):
        for number, member in enumerate(value if path == ("bodies",) else value[:MEMBERS]):
            yield from places(member, (*path, number))


def name_of(path: Place) -> str:
    steps = ("[]" if isinstance(step, int) else f".{step}" for step in path)
    return "".join(steps).lstrip(".")


def at(document: Any, path: Place) -> Any:
    for step in path:
        document = document[step]
    return document


def false_values(path: Place, value: Any) -> Iterator[Any]:
    """Other values that the schema may allow."""
    if isinstance(value, bool):
        yield not value
    elif isinstance(value, int):
        yield from (value + 1, value - 1)
    elif isinstance(value, float):
        beside = () if "centre" in path else (value + 0.125,)  # where a ball may be as true
        yield from (*beside, value * 1.5 + 1.0, -value - 0.25, 1e9)
    elif isinstance(value, str):
        yield from (word for word in WORDS.get(str(path[-1]), ()) if word != value)
    elif isinstance(value, list):
        yield [*value, *value[-1:]] if value else ["x"]
        yield value[:-1]
        if len(value) > 1 and isinstance(value[0], float):
            yield value[::-1]
    elif value is None:
        yield from PLAUSIBLE
        yield from WORDS.get(str(path[-1]), ())
    if value is not None:
        yield None


def ill_formed(value: Any) -> Iterator[Any]:
    """Values of another type, unknown keys and missing ones."""
    yield from (word for word in ("x", {}, [[]]) if word != value)
    if isinstance(value, dict):
        yield value | {"unknown": 1}
        for key in value:
            yield {other: member for other, member in value.items() if other != key}


def is_no_lie(path: Place, value: Any, forged: Any) -> bool:
    """What is as true as before: the same value, or less said."""
    if value == forged and type(value) is type(forged):
        return True
    if forged is None and (
        COVERAGE[entry_of(path)].kind in ("stated", "not covered", "certified")
        or path[-1] in ("witness", "body")
    ):
        return path[-1] != "undecided"
    if path[-1] == "certificate" and isinstance(forged, dict) and forged.keys() < value.keys():
        return True  # what it proved is then named as not covered, or rejected
    if path == ("pose",) and forged == {}:
        return True
    if isinstance(value, dict) and isinstance(forged, dict) and "microseconds" in value:
        return {**forged, "microseconds": 0} == {**value, "microseconds": 0}
    if path[-1] == "convex" and None in (value, forged):  # null: no pair had to know
        return True
    if path == ("summary", "by_relation") and isinstance(forged, dict):
        return {k: n for k, n in forged.items() if n} == {k: n for k, n in value.items() if n}
    # A lower end that is lower still, of an interval.
    is_lower_end = path[-2:] in (("depth_bounds", 0), ("thickness_bounds", 0))
    return is_lower_end and isinstance(forged, float) and 0 <= forged <= value


def entry_of(path: Place) -> str:
    """Of the table of coverage; of a list or an object, of one of its members."""
    name = name_of(path)
    entries = [e for e in COVERAGE if speaks_of(e, name) or speaks_of(name, e)]
    return entries[0]


def left_uncovered(found: VerificationReport, path: Place) -> bool:
    """Whether the checker says of this very place that it is not covered."""
    return entry_of(path) in {one.field for one in found.not_covered}


@cache
def said_before(name: str) -> frozenset[tuple[str, bool]]:
    """The fields of the reports before this one, and whether they are null there."""
    before = takewhile(lambda other: other != name, HONEST)
    documents = [honest(other) for other in before]
    return frozenset((name_of(path), at(d, path) is None) for d in documents for path in places(d))


def lies_about(name: str) -> Iterator[tuple[Place, Any]]:
    """Of one report. Outside of the findings and the summary it is forged only where it is the
    first that says something, and so is its form."""
    document = honest(name)
    for path in places(document):
        value = at(document, path)
        is_first = (name_of(path), value is None) not in said_before(name)
        of_result = path[0] == "summary" or (path[0] == "findings" and "plan" not in path)
        if len(document["bodies"]) > 2:
            of_result &= path[-1] in JUDGED
        if name == "moving":  # nothing of it is accepted anyway
            is_first, of_result = is_first and bool({"motion", "motions"} & {*path}), False
        lies = list(false_values(path, value)) if is_first or of_result else []
        if is_first and value is not None:
            lies += ill_formed(value)
        if COVERAGE[entry_of(path)].kind in ("stated", "not covered"):
            lies = lies[:1] + lies[-1:]  # whatever it says, it is named
        for false in lies:
            if not is_no_lie(path, value, false):
                yield path, false


def forged(name: str, path: Place, false: Any) -> Json:
    document = honest(name)
    at(document, path[:-1])[path[-1]] = false
    return document


@pytest.mark.parametrize("name", HONEST)
def test_an_honest_report_is_accepted(name: str) -> None:
    found = verified(honest(name))
    if name != "moving":  # what happens on the way has no certificates
        assert found.accepted, (found.faults, [one.reason for one in found.findings])
    assert not found.rejected


@pytest.mark.parametrize("name", HONEST)
def test_a_false_claim_is_rejected_or_named(name: str) -> None:
    for path, false in lies_about(name):
        try:
            found = verified(forged(name, path, false))
        except Rejected:
            continue
        if found.accepted and not left_uncovered(found, path):
            pytest.fail(f"{name_of(path)}: {false!r} instead of {at(honest(name), path)!r}")


def test_each_field_is_forged_in_some_report() -> None:
    lied_about = {name_of(path) for name in HONEST for path, _ in lies_about(name)}
    for field in FIELDS:
        assert any(speaks_of(field, at) or speaks_of(at, field) for at in lied_about), field


def keeps_its_clearance(made: Json) -> None:
    made["findings"][0].update(severity="note", rule=None)
    made["summary"]["verdict"] = "pass"


def is_deep(made: Json) -> None:
    low, _ = made["findings"][0]["depth_bounds"]
    made["findings"][0].update(depth=1e9, depth_bounds=[low, 1e9], quality="bounded")


def is_shallow(made: Json) -> None:
    made["findings"][0].update(depth=0.25, depth_bounds=[0.25, 0.25], quality="exact")


def is_thinner(made: Json) -> None:
    low, high = made["findings"][0]["thickness_bounds"]
    thin = (low + high) / 2
    made["findings"][0].update(thickness=thin, thickness_bounds=[low, thin])


def is_thicker(made: Json) -> None:
    """By a ball of the radius of the upper end, and more."""
    _, high = made["findings"][0]["thickness_bounds"]
    made["findings"][0].update(thickness=2 * high, thickness_bounds=[1.01 * high, 2 * high])
    made["findings"][0]["ball"]["radius"] = 0.505 * high


def is_elsewhere(made: Json) -> None:
    made["findings"][0]["ball"]["centre"] = [3.0, 3.0, 2.0]  # in the notch


def merely_touches(made: Json) -> None:
    made["findings"][0].update(relation="touching", severity="note")
    made["summary"].update(verdict="pass")


def meets(made: Json) -> None:
    contacts = honest("touching")["findings"][0]["contacts"]
    made["findings"][0].update(contacts=contacts)


def has_a_component(made: Json) -> None:
    common = Component(
        bounds=((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
        point=(0.5, 0.5, 0.5),
        thickness_bounds=(1.0, 1.0),
        curves=0,
        curve_length=0.0,
        passes="none",
        resolved=True,
    )
    made["findings"][0].update(components=to_builtins(Components((common,))))


def is_called_deep(made: Json) -> None:
    made["findings"][0].update(relation="penetrating", severity="error")
    made["summary"].update(verdict="fail")


def is_called_near(made: Json) -> None:
    made["findings"][0].update(relation="near")


TOGETHER = {
    "a touch that is called an overlap": ("a way out in the touch band", is_called_deep),
    "a touch that is called near": ("a gap in the touch band", is_called_near),
    "a gap below the clearance is a note": ("a gap in the touch band", keeps_its_clearance),
    "a depth far beyond the way out": ("concave", is_deep),
    "a depth below the way out": ("concave", is_shallow),
    "contacts of bodies that are apart": ("apart", meets),
    "a common part of bodies that are apart": ("apart", has_a_component),
    "a thickness below what the cells show": ("thinner than deep", is_thinner),
    "a ball that is too large": ("thinner than deep", is_thicker),
    "a ball outside of a body": ("thinner than deep", is_elsewhere),
    "an overlap that is called a touch for being thin": ("thinner than deep", merely_touches),
}


@pytest.mark.parametrize("lie", TOGETHER)
def test_lies_that_fit_each_other_are_rejected(lie: str) -> None:
    name, forge = TOGETHER[lie]
    made = honest(name)
    forge(made)
    assert [one.outcome for one in verified(made).findings] == ["rejected"]
