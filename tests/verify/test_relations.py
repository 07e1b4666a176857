"""Each kind of certificate, forged: no false relation is ever accepted, and nothing crashes."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.verify.reports import PAIRS, Json, forged, report_of

RELATIONS = ("separated", "touching", "penetrating", "contains", "inside", "coincident")
KINDS = ("boxes-apart", "boxes-flush", "box-in-arm", "boxes-overlap", "sheets-cross", "same-box")
FALSE = [(name, said) for name, (truth, *_) in PAIRS.items() for said in RELATIONS if said != truth]
OVERLAP = ("penetrating", "surfaces")
SEVERITIES = {"separated": "none", "touching": "note"}


def claim(finding: Json, relation: str) -> None:
    """Everything in the finding that a forger of the relation would adapt."""
    finding.update(relation=relation, exact_relation=relation)
    finding["severity"] = SEVERITIES.get(relation, "error")


def certificate_of(name: str) -> Json:
    found: Json = report_of(name)["findings"][0]["certificate"]
    return found


@pytest.mark.parametrize(("name", "relation"), FALSE)
def test_no_certificate_proves_a_false_relation(name: str, relation: str) -> None:
    for certificate in [certificate_of(name), *map(certificate_of, KINDS)]:

        def forge(finding: Json, certificate: Json = certificate) -> None:
            claim(finding, relation)
            finding["certificate"] = certificate

        found = forged(name, forge).findings[0]
        assert found.outcome == "rejected", certificate
        assert "cannot be checked" not in (found.reason or "")


def relation_part(change: Callable[[Json], Any]) -> Callable[[Json], None]:
    def forge(finding: Json) -> None:
        change(finding["certificate"]["relation"])

    return forge


def next_to(value: float) -> float:
    return math.nextafter(value, math.inf)


def weight(part: Json, key: str, value: Any) -> None:
    part["contact"][key]["weights"][0] = value


FORGED: dict[str, tuple[str, Callable[[Json], Any]]] = {
    "axis against itself": ("boxes-apart", lambda r: r.update(axis=[-1, 0, 0])),
    "axis across": ("boxes-apart", lambda r: r.update(axis=[0, 1, 0])),
    "axis of length 0": ("boxes-apart", lambda r: r.update(axis=[0, 0, 0])),
    "axis of text": ("boxes-apart", lambda r: r.update(axis=["nan", "1", "0"])),
    "axis over 0": ("boxes-apart", lambda r: r.update(axis=["1/0", 0, 0])),
    "axis of truths": ("boxes-apart", lambda r: r.update(axis=[True, False, False])),
    "axis too short": ("boxes-apart", lambda r: r.update(axis=[1, 0])),
    "axis too long a number": ("boxes-apart", lambda r: r.update(axis=["9" * 5000, 0, 0])),
    "axis of an exponent": ("boxes-apart", lambda r: r.update(axis=["1e999999999", 0, 0])),
    "axis missing": ("boxes-apart", lambda r: r.pop("axis")),
    "axis tilted": ("boxes-flush", lambda r: r.update(axis=[1, 2**-60, 0])),
    "kind missing": ("boxes-apart", lambda r: r.pop("kind")),
    "kind of a list": ("boxes-apart", lambda r: r.update(kind=["axis"])),
    "contact elsewhere": ("boxes-flush", lambda r: r["contact"]["a"].update(vertices=[0])),
    "contact of weights": ("boxes-flush", lambda r: weight(r, "a", "2/3")),
    "contact beyond": ("boxes-flush", lambda r: weight(r, "b", -1)),
    "contact of no vertex": (
        "boxes-flush",
        lambda r: r["contact"]["a"].update(vertices=[10**30], weights=[1]),
    ),
    "contact below": (
        "boxes-flush",
        lambda r: r["contact"]["a"].update(vertices=[-1], weights=[1]),
    ),
    "no contact": ("boxes-flush", lambda r: r.pop("contact")),
    "triangles beyond": ("box-in-arm", lambda r: r.update(triangles=[0, 12])),
    "triangles below": ("box-in-arm", lambda r: r.update(triangles=[-1, 0])),
    "triangles of one": ("box-in-arm", lambda r: r.update(triangles=[0])),
    "face dropped": ("boxes-overlap", lambda r: r["faces"].pop()),
    "face turned": ("boxes-overlap", lambda r: r["faces"][0].reverse()),
    "face twice": ("boxes-overlap", lambda r: r["faces"].append(r["faces"][0])),
    "vertex of the far side": ("boxes-overlap", lambda r: r["vertices"].__setitem__(0, [0, 7])),
    "vertex beyond": ("boxes-overlap", lambda r: r["vertices"].__setitem__(0, [0, 8])),
    "no faces": ("boxes-overlap", lambda r: r.update(faces=[])),
    "a reaches": ("boxes-overlap", lambda r: r.update(a_reaches=r["b_reaches"])),
    "triangles of text": ("sheets-cross", lambda r: r.update(triangles=["0", "0"])),
}


@pytest.mark.parametrize("lie", FORGED)
def test_a_forged_certificate_is_rejected(lie: str) -> None:
    name, change = FORGED[lie]
    found = forged(name, relation_part(change)).findings[0]
    assert found.outcome == "rejected"
    assert "cannot be checked" not in (found.reason or "")


@pytest.mark.parametrize("name", [name for name in PAIRS if PAIRS[name][:2] == OVERLAP])
def test_an_overlap_is_found_wherever_the_triangles_are(name: str) -> None:
    """They say where to look first, and claim nothing."""
    for triangles in (None, [0, 0], [1, 0], [0, 1]):

        def forge(finding: Json, triangles: list[int] | None = triangles) -> None:
            proof = {"kind": "surfaces", **({} if triangles is None else {"triangles": triangles})}
            finding["certificate"]["relation"] = proof

        assert forged(name, forge).findings[0].outcome == "accepted", triangles


def nodes(value: Any) -> list[tuple[Any, Any]]:
    """Every place in JSON values that can be overwritten: (container, key)."""
    keys = value.keys() if isinstance(value, dict) else range(len(value))
    found = [(value, key) for key in keys]
    for _, key in list(found):
        if isinstance(value[key], dict | list):
            found += nodes(value[key])
    return found


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=3)
    ),
    max_leaves=8,
)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(
    st.sampled_from(sorted(PAIRS)),
    st.sampled_from(RELATIONS),
    st.sampled_from((*KINDS, None)),
    st.lists(st.tuples(st.integers(0), JSON), max_size=3),
)
def test_no_mutation_makes_a_falsehood_true(
    name: str, relation: str, source: str | None, changes: list[tuple[int, Any]]
) -> None:
    certificate = json.loads(json.dumps(certificate_of(source or name)))
    for place, value in changes:
        places = nodes(certificate)
        container, key = places[place % len(places)]
        container[key] = value

    def forge(finding: Json) -> None:
        claim(finding, relation)
        finding["certificate"] = certificate

    found = forged(name, forge).findings[0]
    assert "cannot be checked" not in (found.reason or "")
    if relation != PAIRS[name][0]:
        assert found.outcome != "accepted"
