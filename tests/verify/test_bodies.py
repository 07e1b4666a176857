"""Bodies without a mesh file: what a report states of their shape is enough to check it again."""

from __future__ import annotations

import json
from typing import Any

import pytest
from msgspec.structs import replace

from satcheck.audit import Settings, check
from satcheck.core.shapes import Box, Sphere
from satcheck.scene import Body, Scene
from satcheck.scene.inspect import shape_file
from satcheck.verify import Rejected
from tests.cli.process import VALIDATOR
from tests.verify.reports import Json, is_accepted, verified

SHAPE = Box((1.0, 2.0, 3.0))
SHIFT = (1.0, 0.0, 0.0, 0.75, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def report(groups: tuple[str, ...] = (), ignored: str = "") -> Json:
    first = Body("a", "a", shape_file(SHAPE, "cell.toml"), groups=groups, shape=SHAPE)
    bodies = (first, replace(first, id="b", transform=SHIFT))
    scene = Scene("", None, bodies, ignore_within_groups=frozenset(ignored))
    made: Json = json.loads(json.dumps(check(scene, Settings(certificate=True)).to_dict()))
    VALIDATOR.validate(made)
    return made


def test_two_boxes_are_checked_from_their_sizes() -> None:
    document = report()
    (finding,) = document["findings"]
    assert (finding["relation"], finding["depth"], finding["quality"]) == (
        "penetrating",
        0.25,
        "exact",
    )
    assert document["bodies"][0]["shape"] == {"type": "box", "size": [1.0, 2.0, 3.0]}
    found = verified(document)
    assert found.accepted
    assert [one.outcome for one in found.findings] == ["accepted"]


@pytest.mark.parametrize(
    "shape",
    [
        {"type": "box", "size": [0.1, 2.0, 3.0]},
        {"type": "box", "size": [0.0, 2.0, 3.0]},
        {"type": "sphere", "radius": 1.0},
        {"type": "cube"},
        "box",
        None,
    ],
)
def test_a_shape_that_is_not_the_one_that_was_checked_proves_nothing(shape: Any) -> None:
    document = report()
    document["bodies"][0]["shape"] = shape
    assert not is_accepted(document)


def test_a_pair_within_one_of_several_ignored_groups_is_exempt() -> None:
    document = report(("x", "y"), "yz")
    assert document["summary"]["pairs"]["total"] == 0
    assert verified(document).accepted
    document["bodies"][0]["groups"] = ["x"]
    assert not verified(document).accepted


@pytest.mark.parametrize("groups", [None, "x", [1], {}])
def test_groups_that_are_no_list_of_texts_make_it_no_report(groups: Any) -> None:
    document = report()
    document["bodies"][0]["groups"] = groups
    with pytest.raises(Rejected, match="groups"):
        verified(document)


def test_curved_shapes_are_placed_as_what_they_are() -> None:
    sphere, apart = Sphere(1.0), (*SHIFT[:3], 3.0, *SHIFT[4:])
    first = Body("a", "a", shape_file(sphere, "cell.toml"), shape=sphere)
    scene = Scene("", None, (first, replace(first, id="b", transform=apart)))
    for settings in (Settings(certificate=True), Settings(certificate=True, list_pruned=False)):
        document = json.loads(json.dumps(check(scene, settings).to_dict()))
        found = verified(document)
        assert found.accepted, (found.faults, found.not_certified)
        document["bodies"][1]["transform"][3] = 1.0
        assert not verified(document).accepted
        document["bodies"][1]["transform"] = [0.0] * 12 + [0.0, 0.0, 0.0, 1.0]
        assert not verified(document).accepted
