"""What a finding says besides its relation: depth, way out, touch band, severity."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from satcheck.audit import Settings, check
from satcheck.verify import Checked
from tests.audit.shapes import Mesh, open_box, unit_box, write
from tests.audit.shapes import moved as placed
from tests.verify.reports import Json, channel, forged, pieces, report_of, upright, verified


def proven(name: str) -> tuple[bool, bool]:
    finding = verified(report_of(name, depth=True)).findings[0]
    assert finding.outcome == "accepted", finding.reason
    return finding.depth, finding.mtv


def test_what_is_proven() -> None:
    assert proven("boxes-overlap") == (True, True)
    assert proven("box-in-arm") == (True, True)
    assert proven("sheet-in-wall") == (False, True)  # the interval of a sheet is not
    assert proven("boxes-apart") == (False, False)


def finding_of(folder: Path, a: Mesh, b: Mesh, **settings: Any) -> tuple[Checked, Json]:
    """What the checker says of a pair, and the finding itself."""
    files = write(folder, a=a, b=b)
    document = json.loads(
        json.dumps(check(files, Settings(certificate=True, **settings)).to_dict())
    )
    return verified(document).findings[0], document["findings"][0]


def test_a_way_out_may_end_with_two_open_surfaces_in_contact(tmp_path: Path) -> None:
    plate = placed(upright(), 0.0, 0.0, 0.75)
    found, _ = finding_of(tmp_path, channel(), plate, width=1e-6)
    assert (found.outcome, found.depth, found.mtv) == ("accepted", False, True), found.reason


def test_a_way_out_is_as_much_longer_as_rounding_takes(tmp_path: Path) -> None:
    """Half a million from the origin an ulp of a coordinate is more than 1e-9 of this depth."""
    far = 2.0**19
    # The face x + y + z = 2.9 cuts off a corner of the box.
    corners = [(4.0, -0.6, -0.5), (-0.6, 4.0, -0.5), (-0.5, -0.6, 4.0), (5.0, 5.0, 5.0)]
    wedge: Mesh = corners, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    found, said = finding_of(
        tmp_path, placed(unit_box(), far, far, 0.0), placed(wedge, far, far, 0.0)
    )
    assert (found.outcome, found.depth, found.mtv) == ("accepted", True, True), found.reason
    assert math.hypot(*said["mtv"]) > said["depth"] * (1 + 1e-9)


def depth(finding: Json, low: float, high: float) -> None:
    finding.update(depth=high, depth_bounds=[low, high])


def moved(finding: Json, *move: float) -> None:
    finding.update(mtv=list(move))


def up(value: float) -> float:
    return math.nextafter(value, math.inf)


# The boxes overlap by 0.5 along x.
FORGED: dict[str, Callable[[Json], Any]] = {
    "lower bound": lambda f: depth(f, up(0.5), 1.0),
    "upper bound": lambda f: depth(f, 0.25, math.nextafter(0.5, 0.0)),
    "bounds swapped": lambda f: depth(f, 0.5, 0.25),
    "no bounds": lambda f: f.update(depth_bounds=None),
    "bounds of text": lambda f: f.update(depth_bounds=["0.5", "0.5"]),
    "lower faces": lambda f: f["certificate"]["depth"]["lower"]["faces"].pop(),
    "upper axis": lambda f: f["certificate"]["depth"].update(upper=[0, 1, 0]),
    "no way out": lambda f: moved(f, 0.5, 0.0, 0.0),
    "short way out": lambda f: moved(f, -0.5 + 2.0**-50, 0.0, 0.0),
    "long way out": lambda f: moved(f, -0.75, 0.0, 0.0),
    "way out of text": lambda f: f.update(mtv=["x", "y", "z"]),
    "way out of infinity": lambda f: f.update(mtv=[-math.inf, 0.0, 0.0]),
    "way out of the other": lambda f: f.update(mtv_moves="b"),
    "way out unproven": lambda f: f["certificate"].pop("mtv"),
    "way out by nothing": lambda f: f["certificate"].update(mtv={"kind": "same"}),
    "touching": lambda f: f.update(relation="touching", severity="note"),
    "touching by a band": lambda f: (
        f.update(relation="touching", severity="note"),
        f["certificate"].update(band={"axis": [1, 0, 0]}),
    ),
    "touching by a move": lambda f: (
        f.update(relation="touching", severity="note"),
        f["certificate"].update(band={"move": [-0.5, 0, 0], "free": {"kind": "surfaces"}}),
    ),
    "no warning": lambda f: f.update(severity="note"),
    "tolerance": lambda f: f.update(tolerance=0.5),
    "certificate of a list": lambda f: f.update(certificate=[1]),
}


@pytest.mark.parametrize("lie", FORGED)
def test_a_lie_about_a_figure_is_found(lie: str) -> None:
    found = forged("boxes-overlap", FORGED[lie], depth=True).findings[0]
    assert found.outcome == "rejected"
    assert "cannot be checked" not in (found.reason or "")


def test_a_concave_way_out_is_checked_too() -> None:
    short = forged("box-in-arm", lambda f: moved(f, 0.25, 0.0, 0.0), depth=True)
    assert short.findings[0].outcome == "rejected"


@pytest.mark.parametrize("proof", [None, {"kind": "surfaces"}])
def test_a_way_out_without_proof_makes_no_touch(proof: Json | None) -> None:
    """Half a unit deep, and said to touch: what is not proven is no reason for it."""

    def touch(finding: Json) -> None:
        finding.update(relation="touching", severity="note")
        depth(finding, 0.0, 1e-9)
        moved(finding, 1e-9, 0.0, 0.0)
        finding["certificate"].update(mtv=proof)

    found = forged("box-in-arm", touch, depth=True).findings[0]
    assert found.outcome == "rejected"
    assert "cannot be checked" not in (found.reason or "")


def test_a_proven_way_out_makes_a_touch_by_its_own_length(tmp_path: Path) -> None:
    """Far from the origin it may be longer than the depth that is said, by what rounding takes."""
    far, deep = 2.0**30, 2.0**-10
    a = pieces(unit_box(far, edge=4.0), unit_box(far + 8.0))
    scene = write(tmp_path, a=a, b=unit_box(far + 4.0 - deep, 1.0, 1.0))
    document: Json = check(scene, Settings(certificate=True, tolerance=1e-9, cache=False)).to_dict()
    finding = document["findings"][0]
    assert verified(document).findings[0].mtv
    depth(finding, 0.0, 0.0)
    finding["certificate"].pop("cover", None)
    finding["quality"] = "exact"
    assert verified(document).findings[0].outcome == "accepted"
    finding.update(relation="touching", severity="note")
    assert verified(document).findings[0].outcome == "rejected"


def test_open_parts_are_sheets_only_where_the_settings_say_so(tmp_path: Path) -> None:
    a, b = open_box(), unit_box(1.0, 1.0, 1.0)
    files = write(tmp_path, a=a, b=b)
    report = check(files, Settings(certificate=True, allow_open=True)).to_dict()
    document = json.loads(json.dumps(report))
    assert verified(document).findings[0].outcome == "accepted"
    document["settings"]["allow_open"] = False
    assert verified(document).findings[0].outcome == "rejected"
    document["findings"][0].update(severity="warning", undecided="inside")
    assert verified(document).findings[0].outcome == "rejected"
