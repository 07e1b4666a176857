"""Sheets, solids and holes in one file, as certificates and forged reports show them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.scene import load_scene
from satcheck.verify.meshes import bounds_nothing, with_backs
from tests.audit.shapes import Mesh, moved, open_box, unit_box, write
from tests.verify.reports import Json, pieces, sheet, turned, upright, verified

BOX = unit_box(edge=4.0)
SMALL = unit_box(1.0, 1.0, 1.0)
FLOOR = moved(sheet(edge=2.0), 1.0, 1.0, 1.5)  # through the small box


# A wall that ends within the box, and one that joins it all around.
WITH_WALL = (BOX[0], [*BOX[1], (0, 1, 7)])
WITH_FULL_WALL = (BOX[0], [*BOX[1], (0, 1, 7, 6)])


def arrays(mesh: Mesh) -> tuple[Any, Any]:
    points, faces = mesh
    fans = [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)]
    return np.array(points, dtype=float), np.array(fans, dtype=np.int64)


@pytest.mark.parametrize(
    ("mesh", "filled", "meant"),
    [
        (BOX, 0, 0),
        (sheet(), 2, 2),
        (pieces(BOX, FLOOR), 2, 2),
        (open_box(), None, 10),
        (pieces(BOX, open_box()), None, None),  # copies of faces of the box
        (pieces(BOX, moved(open_box(), 9.0, 0.0, 0.0)), None, 10),
        (pieces(sheet(), turned(sheet())), 0, 0),
        (WITH_WALL, None, 1),
        (WITH_FULL_WALL, None, None),
    ],
)
def test_which_triangles_are_of_sheets(mesh: Mesh, filled: int | None, meant: int) -> None:
    points, triangles = arrays(mesh)
    for allow_open, backs in ((False, filled), (True, meant)):
        both = with_backs(points, triangles, allow_open=allow_open)
        if backs is None:
            assert both is None
        else:
            assert len(both) == len(triangles) + backs
            assert (both[len(triangles) :, 1] < len(points)).all()


def test_a_surplus_copy_has_no_rim_and_makes_no_sheet() -> None:
    points, triangles = arrays(pieces(BOX, moved(sheet(), 9.0, 0.0, 0.0)))
    surplus = np.vstack([triangles, triangles[:1]])
    assert with_backs(points, surplus, allow_open=True) is None  # the copy leaves a hole


def test_what_cancels_bounds_nothing() -> None:
    points, triangles = arrays(sheet())
    assert bounds_nothing(points, np.vstack([triangles, triangles[:, ::-1]]))
    assert not bounds_nothing(*arrays(BOX))
    assert not bounds_nothing(*arrays(sheet()))


def report(folder: Path, a: Mesh, b: Mesh, **settings: Any) -> Json:
    scene = load_scene(write(folder, a=a, b=b))
    made: Json = json.loads(
        json.dumps(check(scene, Settings(certificate=True, **settings)).to_dict())
    )
    return made


def outcome(document: Json) -> str:
    (finding,) = verified(document).findings
    return finding.outcome


def claim_separated(document: Json) -> None:
    (finding,) = document["findings"]
    figures = ("distance", "depth", "depth_bounds", "normal", "mtv", "mtv_moves", "mtv_verified")
    finding.update(dict.fromkeys((*figures, "witness", "reason")))
    finding.update(relation="separated", exact_relation="separated", quality="exact")
    finding.update(severity="none", undecided=None, rule=None)
    finding["certificate"] = {"relation": {"kind": "surfaces"}}


BESIDE = {
    "a bowl": moved(open_box(), 9.0, 0.0, 0.0),
    "a floor": moved(sheet(), 9.0, 0.0, 0.0),
    "a floor within": FLOOR,
}


@pytest.mark.parametrize("beside", BESIDE.values(), ids=BESIDE)
def test_a_closed_part_stays_solid_beside_open_ones(tmp_path: Path, beside: Mesh) -> None:
    document = report(tmp_path, pieces(BOX, beside), SMALL, allow_open=True)
    assert document["findings"][0]["relation"] == "contains"
    assert outcome(document) == "accepted"
    claim_separated(document)
    assert outcome(document) == "rejected"


def test_a_box_over_a_floor_of_the_same_file_is_certified(tmp_path: Path) -> None:
    room = pieces(sheet(edge=9.0), moved(unit_box(), 5.0, 5.0, 0.0))
    document = report(tmp_path, room, unit_box(3.5, 3.5, 0.25))
    assert document["findings"][0]["relation"] == "separated"
    assert outcome(document) == "accepted"


def test_what_may_lie_in_a_hole_is_not_taken_for_separated(tmp_path: Path) -> None:
    """Nor with the warning that the inside was not checked."""
    document = report(tmp_path, open_box(), SMALL)
    claim_separated(document)
    assert outcome(document) == "rejected"
    document["findings"][0].update(severity="warning", undecided="inside")
    assert outcome(document) == "rejected"


def test_a_way_out_into_a_hole_is_none(tmp_path: Path) -> None:
    """The surfaces are free of each other where the box has come to lie within the open one."""
    across = unit_box(1.5, 1.5, -0.25)
    document = report(tmp_path, across, open_box(), depth=True)
    (finding,) = document["findings"]
    assert outcome(document) == "accepted"
    finding.update(mtv=[0.0, 0.0, 0.25], depth=0.25, depth_bounds=[0.0, 0.25], witness=None)
    finding.update(normal=[0.0, 0.0, -1.0], quality="bounded")
    finding["certificate"]["mtv"] = {"kind": "surfaces"}
    assert outcome(document) == "rejected"


def test_a_clearance_from_what_fills_a_hole_is_not_certified(tmp_path: Path) -> None:
    """A bowl that lies on its side: its rim is at x = 4, and what fills it may bulge nowhere, but
    its walls are farther from the box than its rim plane."""
    points, faces = open_box()
    bowl = [(z, y, x) for x, y, z in points], faces
    document = report(tmp_path, bowl, unit_box(4.25, 1.5, 1.5), clearance=0.5)
    claim_separated(document)
    assert outcome(document) == "rejected"


def test_sheets_that_cross_themselves_are_not_shown_to_stick_out_of_each_other(
    tmp_path: Path,
) -> None:
    """A floor with a wall across, and the same once more."""
    cross = pieces(sheet(), upright())
    document = report(tmp_path, cross, cross)
    (finding,) = document["findings"]
    assert finding["relation"] == "coincident"
    claim_separated(document)
    finding.update(relation="penetrating", exact_relation="penetrating", severity="error")
    for s in (0, 1):
        for t in (2, 3):
            finding["certificate"]["relation"] = {"kind": "crossing", "triangles": [s, t]}
            assert outcome(document) == "rejected"
