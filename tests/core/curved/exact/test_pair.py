"""Contacts that float64 states exactly: touching, one unit in the last place apart, one within."""

from __future__ import annotations

import numpy as np
import pytest

from satcheck.audit.body import PlacedBody, SharedMesh
from satcheck.audit.settings import Settings
from satcheck.core.curved.exact.pair import proven
from satcheck.core.curved.signed import convex_pair
from satcheck.scene import Body
from tests.core.curved.bodies import ask
from tests.core.curved.exact.contacts import all_contacts, bodies, turn

CONTACTS = all_contacts()
IDENTITY = (1, 0, 0, 0)
TRUTH = {0: "touching", 1: "separated", -1: "penetrating"}


def relation(*pair: Body) -> str | None:
    found = ask(*pair, tolerance=0.0)
    if found.exact_relation == "penetrating":
        assert found.mtv_verified
    else:
        assert found.relation == found.exact_relation
        assert found.quality == "exact"
    return found.exact_relation


@pytest.mark.parametrize("number", range(len(CONTACTS)), ids=lambda k: CONTACTS[k].name)
def test_touching_and_one_ulp_off(number: int) -> None:
    contact, rng = CONTACTS[number], np.random.default_rng(number)
    turned = tuple(rng.integers(1, 5, 4).tolist())
    for quaternion, scale in ((IDENTITY, 1.0), (turned, 2.0 ** rng.integers(-60, 60))):
        for ulps, truth in TRUTH.items():
            if ulps < 0 and contact.at_edge:
                continue
            a, b = bodies(contact, turn(quaternion), ulps, scale)
            assert relation(a, b) == truth, (quaternion, ulps)
            assert relation(b, a) == truth, (quaternion, ulps)


def test_rounded_poses_are_decided_within_their_bounds() -> None:
    """Rotations, rounded: faces are no longer parallel. What is proven agrees with the bounds."""
    rng, decided = np.random.default_rng(2), 0
    for contact in CONTACTS:
        quaternion = rng.normal(size=4)
        frame = turn(tuple((quaternion / np.linalg.norm(quaternion)).tolist()))
        a, b = (
            PlacedBody(body, SharedMesh(body.file, Settings()))
            for body in bodies(contact, frame, 0)
        )
        bounds = convex_pair(a, b)
        assert bounds is not None
        found, proof = proven(a, b, bounds)
        assert bounds.lower <= found.lower <= found.distance <= found.upper <= bounds.upper, proof
        decided += found.exact
    assert decided > 0.9 * len(CONTACTS)
