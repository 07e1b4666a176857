"""Certificates of curved shapes: what is true is accepted, what is changed in them is not."""

from __future__ import annotations

import copy
import json
from typing import Any

import pytest

from satcheck.audit import Settings, check
from satcheck.core.shapes import Box, Cone, Cylinder, Ellipsoid, Sphere
from satcheck.scene import Body, Scene
from satcheck.verify import VerificationReport
from tests.core.curved.bodies import moved, shape, tilted
from tests.core.curved.exact.contacts import all_contacts, bodies, turn
from tests.verify.reports import Json, verified

CONTACTS = {contact.name: contact for contact in all_contacts()}
SOME = (
    "can at 0.0, 0.0",
    "lying can at 4.0, 3.0",
    "cone on its tip at 1.25, -0.5",
    "a log along the edge",
    "egg on can",
    "capsule on cone",
    "crossed cans",
    "balls",
    "Cylinder beside Capsule",
    "cans rim to rim",
)


def report(*pair: Body, **settings: Any) -> Json:
    asked = Settings(certificate=True, depth=True, **settings)
    scene = Scene("", None, pair, order=tuple(body.id for body in pair))
    made: Json = json.loads(json.dumps(check(scene, asked).to_dict()))
    return made


def changed(document: Json, *path: str | int, to: Any) -> VerificationReport:
    other = copy.deepcopy(document)
    place = other["findings"][0]
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = to
    return verified(other)


@pytest.mark.parametrize("name", SOME)
def test_contacts(name: str) -> None:
    contact = CONTACTS[name]
    for ulps in (0, 1) if contact.at_edge else (0, 1, -1):
        pair = bodies(contact, turn((1, 2, 0, 1)), ulps)
        document = report(*pair, tolerance=0.0)
        finding = document["findings"][0]
        assert finding["exact_relation"] == ("touching", "separated", "penetrating")[ulps]
        assert verified(document).accepted
        for relation in ("touching", "separated", "penetrating", "contains", "inside"):
            if relation != finding["exact_relation"]:
                assert not changed(document, "exact_relation", to=relation).accepted


def test_a_point_that_is_not_common_proves_no_touch() -> None:
    document = report(shape("a", Box((2.0, 2.0, 2.0))), shape("b", Cylinder(0.5, 1.0), up(1.5)))
    contact = ("certificate", "relation", "contact")
    assert verified(document).accepted
    for point in ([0.0, 0.0, 1.25], [0.0, 0.0, 0.5], [5.0, 0.0, 1.0], [0.0, 0.0], None):
        assert not changed(document, *contact, "b", "point", to=point).accepted
    assert not changed(document, *contact, "a", "weights", to=[1.0]).accepted
    assert not changed(document, "certificate", "relation", "axis", to=[0, 0, -1]).accepted
    assert not changed(document, "certificate", "relation", "axis", to=[0, 1, 5]).accepted


def up(z: float) -> tuple[float, ...]:
    return moved(0.0, 0.0, z)


def test_deep_and_far() -> None:
    box, egg = shape("a", Box((2.0, 2.0, 2.0))), Ellipsoid((1.0, 0.5, 0.25))
    deep = report(box, shape("b", egg, tilted(33.0, 1.0, 0.25, 0.5)))
    assert deep["findings"][0]["exact_relation"] == "penetrating"
    found = verified(deep)
    assert found.accepted
    assert found.findings[0].mtv
    shorter = [0.5 * c for c in deep["findings"][0]["mtv"]]
    assert not changed(deep, "mtv", to=shorter).accepted
    leads = "certificate", "relation"
    assert not changed(deep, *leads, "a_reaches", to=[1, 0, 0]).accepted
    far = report(box, shape("b", egg, tilted(33.0, 1.5, 2.0, 1.5)), clearance=0.25)
    assert verified(far).accepted


def test_one_in_the_other() -> None:
    can, box = Cylinder(0.5, 0.5), Box((2.0, 2.0, 2.0))
    for pair in ((shape("a", box), shape("b", can)), (shape("a", can), shape("b", box))):
        assert verified(report(*pair)).accepted
    for pair in (
        (shape("a", Sphere(9.0)), shape("b", box)),
        (shape("a", box), shape("b", Sphere(9.0))),
    ):
        assert verified(report(*pair)).accepted
    flush = report(shape("a", box), shape("b", can, up(0.75)))
    assert flush["findings"][0]["exact_relation"] == "penetrating"
    assert verified(flush).accepted
    assert not changed(flush, "certificate", "relation", to={"kind": "nested"}).accepted


def test_within_the_touch_band() -> None:
    table = shape("a", Box((2.0, 2.0, 2.0)))
    for z in (1.5 + 1e-9, 1.5 - 1e-9):
        document = report(table, shape("b", Cone(0.5, 1.0), up(z)), tolerance=1e-6)
        assert document["findings"][0]["relation"] == "touching"
        assert verified(document).accepted
        document["settings"]["tolerance"] = document["findings"][0]["tolerance"] = 1e-10
        assert not verified(document).accepted
