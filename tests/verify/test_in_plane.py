"""Reports about outlines in a plane: true ones are accepted, and none of them fits another view."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import pytest

from satcheck.core.conventions import PLANES, Plane
from tests.audit.shapes import bracket, unit_box, write
from tests.verify.honest import body, document, meshes, placed
from tests.verify.reports import PAIRS, Json, is_accepted, verified
from tests.verify.test_relations import RELATIONS, claim

# A square, a ball that overlaps it, a clamp that holds a block, and a block beside it.
LAYOUT = {
    "a": ([[0, 0], [10, 0], [10, 10], [0, 10]], [0, 0, 0]),
    "c": ([[0, 0], [20, 0], [20, 20], [15, 20], [15, 5], [5, 5], [5, 20], [0, 20]], [20, 0, 0]),
    "d": ([[0, 0], [3, 0], [3, 3], [0, 3]], [27, 7, 0]),
    "e": ([[0, 0], [3, 0], [3, 3], [0, 3]], [40, 0, 0]),
}
SETTINGS: tuple[Json, ...] = ({"depth": True}, {"clearance": 1.5})


def proven(made: Json) -> None:
    found = verified(made)
    assert found.accepted, (found.faults, [one.reason for one in found.findings])
    assert not found.not_certified
    made["settings"]["planar"] = None
    assert not is_accepted(made)


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("name", PAIRS)
def test_outlines_of_meshes(name: str, plane: Plane, tmp_path: Path) -> None:
    *_, a, b = PAIRS[name]
    for settings in SETTINGS:
        made = document(write(tmp_path, a=a, b=b), planar=plane, **settings)
        if made["findings"][0]["relation"] != "indeterminate":  # seen edge on
            proven(made)


@pytest.mark.parametrize("plane", PLANES)
def test_outlines_of_shapes_as_they_are_placed(plane: Plane, tmp_path: Path) -> None:
    ball = body("ball", {"type": "sphere", "radius": 1.0}, 0.0)
    can = body("can", {"type": "cylinder", "radius": 1.0, "height": 2.0}, 2.5)
    can["position"] = [2.5, 0.5, 0.0]  # else the ball seen along x fits the can
    part = {"id": "part", "mesh": "part.obj", "position": [-1.0, 0.3, 0.0], "euler": [0, 0, 30]}
    made = placed(ball, can, part, settings={"planar": plane, "depth": True})(tmp_path)
    assert made["bodies"][0]["shape"] == {"type": "sphere", "radius": 1.0}
    assert made["bodies"][1]["transform"][3] == 2.5
    proven(json.loads(json.dumps(made)))
    made["bodies"][1]["transform"][7 if plane == "yz" else 3] = 2.0
    assert not is_accepted(made)


CURVES: dict[str, Callable[[Json], Any]] = {
    "a gap of polygons": lambda f: f.pop("distance_bounds"),
    "an exact gap": lambda f: (f.pop("distance_bounds"), f.update(quality="exact")),
    "bounds that are too narrow": lambda f: f["distance_bounds"].__setitem__(0, f["distance"]),
    "a clearance that is kept": lambda f: f.update(severity="none", undecided=None, rule=None),
}


@pytest.mark.parametrize("lie", CURVES)
def test_a_distance_of_polygons_is_not_that_of_curves(lie: str, tmp_path: Path) -> None:
    """The polygons are 0.5225 apart, the balls may be closer by 0.3."""
    one = body("one", {"type": "sphere", "radius": 1000.0}, 0.0)
    two = body("two", {"type": "sphere", "radius": 1000.0}, 2000.5225)
    made = placed(one, two, settings={"planar": "xy", "clearance": 0.5})(tmp_path)
    (finding,) = made["findings"]
    assert (finding["relation"], finding["undecided"]) == ("separated", "limit")
    assert verified(made).findings[0].outcome == "accepted"
    assert "findings[].distance" in verified(made).findings[0].left
    CURVES[lie](finding)
    assert verified(made).findings[0].outcome == "rejected"


def test_a_ball_within_a_ball_needs_room(tmp_path: Path) -> None:
    one = body("one", {"type": "sphere", "radius": 1000.0}, 0.0)
    two = body("two", {"type": "sphere", "radius": 999.0}, 0.0)
    made = placed(one, two, settings={"planar": "xy"})(tmp_path)
    assert made["findings"][0]["relation"] == "contains"
    assert verified(made).findings[0].outcome == "accepted"
    made["bodies"][1]["transform"] = [
        *(1.0, 0.0, 0.0, 0.8, 0.0, 1.0, 0.0, 0.0),
        *(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0),
    ]
    assert verified(made).findings[0].outcome == "rejected"


@pytest.mark.parametrize("key", ["depth_bounds", "mtv"])
def test_a_depth_of_polygons_is_not_that_of_curves(key: str, tmp_path: Path) -> None:
    one = body("one", {"type": "sphere", "radius": 1000.0}, 0.0)
    two = body("two", {"type": "sphere", "radius": 1000.0}, 1999.0)
    made = placed(one, two, settings={"planar": "xy", "depth": True})(tmp_path)
    (finding,) = made["findings"]
    checked = verified(made).findings[0]
    assert (checked.outcome, checked.depth, checked.mtv) == ("accepted", True, True)
    low, _ = finding["depth_bounds"]
    if key == "mtv":
        del finding["certificate"]["depth"]
    finding.update(depth=low, depth_bounds=[low, low], quality="exact", mtv=[-low, 0.0, 0.0])
    assert verified(made).findings[0].outcome == "rejected"


@pytest.mark.parametrize("settings", SETTINGS)
def test_outlines_of_a_scene(settings: Json, tmp_path: Path) -> None:
    bodies = [
        {"id": id_, "shape": {"type": "outline", "points": points}, "position": position}
        for id_, (points, position) in LAYOUT.items()
    ]
    ball = {"id": "b", "shape": {"type": "sphere", "radius": 4}, "position": [12, 5, 0]}
    made = placed(*bodies, ball, settings={"planar": "xy", **settings})(tmp_path)
    assert made["bodies"][0]["shape"]["type"] == "outline"
    relations = {one["relation"] for one in made["findings"]}
    assert relations > {"penetrating", "touching"}
    proven(json.loads(json.dumps(made)))
    made["bodies"][0]["shape"]["points"][1] = [30.0, 0.0]
    assert not is_accepted(made)


def test_a_report_in_space_is_none_in_a_plane(tmp_path: Path) -> None:
    """The boxes lie over each other: seen from above they overlap."""
    made = meshes(unit_box(), unit_box(0.0, 0.0, 3.0))(tmp_path)
    assert is_accepted(made)
    for plane in PLANES:
        made["settings"]["planar"] = plane
        assert not is_accepted(made)


def report(a: Any, b: Any) -> Json:
    return meshes(a, b, planar="xy", depth=True)(Path(mkdtemp()))


VIEWS: dict[str, tuple[Any, Any]] = {
    "overlap": (bracket(), unit_box(5.5, 1.5, 1.0)),
    "a hole": (bracket(), unit_box(2.5, 2.5, 1.0)),
    "held": (unit_box(edge=4.0), unit_box(1.0, 1.0, 9.0)),
    "held by an arm": (bracket(), unit_box(0.5, 0.5, 9.0)),
    "within": (unit_box(1.0, 1.0, 9.0), unit_box(edge=4.0)),
    "the same": (unit_box(), unit_box(0.0, 0.0, 7.0)),
    "flush": (unit_box(), unit_box(1.0, 0.0, 7.0)),
}


@pytest.mark.parametrize("name", VIEWS)
def test_no_other_relation_is_accepted(name: str) -> None:
    honest = report(*VIEWS[name])
    truth = honest["findings"][0]["relation"]
    others = [report(*view)["findings"][0]["certificate"] for view in VIEWS.values()]
    for relation in RELATIONS:
        for certificate in others:
            made = json.loads(json.dumps(honest))
            claim(made["findings"][0], relation)
            if relation != truth:
                made["findings"][0]["certificate"] = certificate
                found = verified(made).findings[0]
                assert found.outcome == "rejected"
                assert "cannot be checked" not in (found.reason or "")


def ends(finding: Json) -> None:
    """Neither holds the other, say axes across the plane: the prisms end at one height."""
    claim(finding, "penetrating")
    finding["certificate"]["relation"].update(a_reaches=[0, 0, 1], b_reaches=[0, 0, 1])


LIES: dict[str, tuple[str, Callable[[Json], Any]]] = {
    "a move out of the plane": ("overlap", lambda f: f["mtv"].__setitem__(2, 1e-12)),
    "a normal out of the plane": ("overlap", lambda f: f["normal"].__setitem__(2, 1e-13)),
    "an axis across": ("held", ends),
}


@pytest.mark.parametrize("lie", LIES)
def test_what_leaves_the_plane_is_rejected(lie: str) -> None:
    name, forge = LIES[lie]
    made = report(*VIEWS[name])
    forge(made["findings"][0])
    assert verified(made).findings[0].outcome == "rejected"


def test_a_point_at_the_end_of_a_prism_is_no_meeting_of_walls(tmp_path: Path) -> None:
    """One outline holds the other. Points inside both, points inside A alone, and a point of both
    ends would show an overlap of prisms of one height."""
    made = meshes(bracket(), unit_box(0.5, 0.5, 1.0), planar="xy")(tmp_path)
    finding = made["findings"][0]
    assert finding["relation"] == "contains"
    claim(finding, "penetrating")
    for triangle in range(made["bodies"][0]["triangles"]):
        finding["certificate"]["relation"] = {"kind": "surfaces", "triangles": [triangle, 0]}
        assert verified(made).findings[0].outcome == "rejected"
