"""Polygons that stand for curves: what is said of the curves is true of them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

from satcheck.audit import Finding, Settings, check
from satcheck.core.shapes import Sphere
from satcheck.scene import Body, Scene, load_scene
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.shape_file import shape_file
from tests.scene.planar.flat import scene, sheet

RADIUS = 1000.0
Circle = tuple[float, float, float]


def drawing(folder: Path, *circles: Circle) -> Scene:
    """A DXF file in millimetres. Each circle is a body."""
    lines = ["0", "SECTION", "2", "HEADER", "9", "$ACADVER", "1", "AC1015"]
    lines += ["9", "$INSUNITS", "70", "4", "0", "ENDSEC", "0", "SECTION", "2", "ENTITIES"]
    for x, y, r in circles:
        lines += ["0", "CIRCLE", "8", "0", "10", repr(x), "20", repr(y), "30", "0", "40", repr(r)]
    path = folder / "discs.dxf"
    path.write_text("\n".join([*lines, "0", "ENDSEC", "0", "EOF", ""]), "utf-8")
    return load_scene([str(path)])


def discs(folder: Path, apart: float, angle: float = 0.0) -> Scene:
    """Two discs with this gap, below 0 an overlap, along a direction."""
    away = 2 * RADIUS + apart
    return drawing(
        folder, (0.0, 0.0, RADIUS), (away * math.cos(angle), away * math.sin(angle), RADIUS)
    )


def balls(apart: float, angle: float = 0.0) -> Scene:
    away = 2 * RADIUS + apart
    bodies = []
    for name, x, y in (("a", 0.0, 0.0), ("b", away * math.cos(angle), away * math.sin(angle))):
        shape = Sphere(RADIUS)
        pose = (1.0, 0, 0, x, 0, 1.0, 0, y, 0, 0, 1.0, 0, 0, 0, 0, 1.0)
        bodies.append(Body(name, name, shape_file(shape, "cell.toml"), pose, shape=shape))
    return Scene("balls", None, tuple(bodies))


def ask(given: Scene, **settings: Any) -> Finding:
    (finding,) = check(given, Settings(planar="xy", **settings)).findings
    return finding


ANGLES = (0.0, 0.003, math.pi / 256, 0.7, math.pi / 4)


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("kind", ["discs", "balls"])
def test_the_bounds_of_a_gap_hold_that_of_the_curves(
    kind: str, angle: float, tmp_path: Path
) -> None:
    given = discs(tmp_path, 0.4, angle) if kind == "discs" else balls(0.4, angle)
    found = ask(given, clearance=0.5)
    assert (found.relation, found.quality) in (("near", "bounded"), ("separated", "bounded"))
    assert found.distance_bounds is not None
    low, high = found.distance_bounds
    rounding = 1e-9 * RADIUS
    assert low - rounding <= 0.4 <= high + rounding
    assert high == pytest.approx(found.distance, abs=rounding)


@pytest.mark.parametrize(
    ("clearance", "relation", "undecided"),
    [(0.25, "separated", None), (0.42, "separated", "limit"), (0.46, "near", None)],
)
def test_a_clearance_is_kept_by_the_curves(
    clearance: float, relation: str, undecided: str | None, tmp_path: Path
) -> None:
    """Of a gap of 0.4, of which the polygons make 0.43."""
    found = ask(discs(tmp_path, 0.4), clearance=clearance)
    assert (found.relation, found.undecided) == (relation, undecided)
    assert found.exact_relation == "separated"


def test_balls_closer_than_the_clearance_do_not_pass() -> None:
    angle = math.pi / 256  # towards the middle of two edges
    assert ask(balls(0.5225, angle), clearance=0.55).severity != "none"


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("kind", ["discs", "balls"])
def test_the_bounds_of_a_depth_hold_that_of_the_curves(
    kind: str, angle: float, tmp_path: Path
) -> None:
    given = discs(tmp_path, -0.7, angle) if kind == "discs" else balls(-0.7, angle)
    found = ask(given, depth=True)
    assert (found.relation, found.exact_relation) == ("penetrating", "penetrating")
    assert found.quality == "bounded"
    assert found.depth_bounds is not None
    low, high = found.depth_bounds
    assert low <= 0.7 <= high == found.depth
    assert found.mtv is not None
    assert found.mtv_verified
    away = 2 * RADIUS - 0.7
    after = math.dist(found.mtv[:2], (away * math.cos(angle), away * math.sin(angle)))
    assert after >= 2 * RADIUS


@pytest.mark.parametrize(
    ("most", "severity", "undecided"),
    [(0.36, "error", None), (0.38, "warning", "limit"), (0.5, "note", None)],
)
def test_a_limit_of_the_depth_is_that_of_the_curves(
    most: float, severity: str, undecided: str | None, tmp_path: Path
) -> None:
    """Of a depth of 0.4, of which the polygons make 0.37."""
    rule = Rule(a=Selector("*"), b=Selector("*"), max_depth=most, where="rules.toml:1")
    found = ask(replace(discs(tmp_path, -0.4), rules=(rule,)))
    assert (found.severity, found.undecided) == (severity, undecided)


def test_without_a_tolerance_the_curves_leave_it_open(tmp_path: Path) -> None:
    """Polygons that miss each other, of discs that overlap."""
    given = discs(tmp_path, -0.01)
    apart = ask(given, tolerance=0.0, clearance=None)
    assert (apart.relation, apart.quality) == ("separated", "estimate")
    assert (apart.exact_relation, apart.undecided) == (None, "relation")
    assert ask(given).relation == "touching"


BLOBS = (
    '<svg xmlns="http://www.w3.org/2000/svg">'
    '<path id="a" d="M0 -1000 C1000 -1000 1000 1000 0 1000 C-1000 1000 -1000 -1000 0 -1000 Z"/>'
    '<path id="b" transform="translate(1499.7 0)" '
    'd="M0 -1000 C1000 -1000 1000 1000 0 1000 C-1000 1000 -1000 -1000 0 -1000 Z"/></svg>'
)


@pytest.mark.parametrize(("clearance", "severity"), [(None, "warning"), (1.0, "error")])
def test_an_overlap_that_the_curves_may_not_have_does_not_fail(
    clearance: float | None, severity: str, tmp_path: Path
) -> None:
    """Of polygons that may reach beyond their curves. Too close the curves are for certain."""
    (tmp_path / "blobs.svg").write_text(BLOBS, "utf-8")
    given = load_scene([str(tmp_path / "blobs.svg")])
    found = ask(given, tolerance=0.0, clearance=clearance)
    assert (found.relation, found.quality) == ("penetrating", "estimate")
    assert (found.severity, found.undecided) == (severity, "relation")


@pytest.mark.parametrize(("room", "shown"), [(0.05, None), (0.2, "contains")])
@pytest.mark.parametrize("swapped", [False, True])
def test_a_disc_in_a_disc(room: float, shown: str | None, swapped: bool, tmp_path: Path) -> None:
    """Within another with more room than the curves may be off."""
    circles = [(0.0, 0.0, RADIUS), (0.0, 0.0, RADIUS - room)]
    found = ask(drawing(tmp_path, *(circles[::-1] if swapped else circles)))
    expected = {"contains": "inside", None: None}[shown] if swapped else shown
    assert found.exact_relation == expected


RING = (
    '<svg xmlns="http://www.w3.org/2000/svg"><path id="ring" fill-rule="evenodd" d="M-1500 -1500 '
    "H1500 V1500 H-1500 Z M1000 0 A1000 1000 0 0 1 -1000 0 A1000 1000 0 0 1 1000 0 Z"
    '"/><circle id="disc" cx="{x}" cy="{y}" r="990"/></svg>'
)


@pytest.mark.parametrize("angle", [0.0, 0.01, 0.7])
def test_a_disc_in_a_hole(angle: float, tmp_path: Path) -> None:
    """It overlaps the plate around the hole by 0.6. The polygon of a hole lies within it, so that
    of the plate reaches out of the plate."""
    reach = 10.6
    text = RING.format(x=reach * math.cos(angle), y=reach * math.sin(angle))
    (tmp_path / "ring.svg").write_text(text, "utf-8")
    found = ask(load_scene([str(tmp_path / "ring.svg")]), depth=True)
    assert found.relation == "penetrating"
    assert found.depth_bounds is not None
    low, high = found.depth_bounds
    assert 0.4 < low <= 0.6 <= high
    assert high < 1.0
    assert found.mtv is not None
    assert found.mtv_verified
    disc = reach * math.cos(angle), reach * math.sin(angle)
    assert math.dist(disc, found.mtv[:2]) <= 10.0  # from the middle of the hole


PIN = (
    '<svg xmlns="http://www.w3.org/2000/svg"><path id="plate" fill-rule="evenodd" d="M-50 -50 H50 '
    "V50 H-50 Z M10 0 A10 10 0 0 1 -10 0 A10 10 0 0 1 10 0 Z"
    '"/><circle id="pin" r="{r}"/></svg>'
)


@pytest.mark.parametrize(
    ("radius", "relation", "quality"),
    [
        (9.99, "separated", "exact"),
        (9.9999, "touching", "bounded"),
        (10.2, "penetrating", "bounded"),
    ],
)
@pytest.mark.parametrize("depth", [False, True])
def test_a_pin_in_a_hole_that_fits_closer_than_the_curves_are_known(
    radius: float, relation: str, quality: str, depth: bool, tmp_path: Path
) -> None:
    """The polygons of both lie within the curves. They interlock, by less than the curves may be
    off: no small move tells that, but how thick the overlap is does."""
    (tmp_path / "pin.svg").write_text(PIN.format(r=radius), "utf-8")
    found = ask(load_scene([str(tmp_path / "pin.svg")]), depth=depth)
    assert found.relation == relation
    if relation == "separated" or depth:
        assert found.quality == quality
    assert found.undecided is None


PLATE = (
    '<path transform="translate({x} {y})" fill-rule="evenodd" d="M0 0 H100 V60 H0 Z '
    'M20 30 A10 10 0 0 1 40 30 A10 10 0 0 1 20 30 Z"/>'
)


@pytest.mark.parametrize(("x", "y"), [(95.0, 0.0), (95.0, 31.0), (2.5, -55.0)])
def test_plates_with_round_holes(x: float, y: float, tmp_path: Path) -> None:
    """What overlaps by 5 are straight edges; the holes say how far any curve may be off."""
    svg = '<svg xmlns="http://www.w3.org/2000/svg">'
    text = f"{svg}{PLATE.format(x=0, y=0)}{PLATE.format(x=x, y=y)}</svg>"
    (tmp_path / "plates.svg").write_text(text, "utf-8")
    found = ask(load_scene([str(tmp_path / "plates.svg")]), depth=True)
    assert found.depth_bounds is not None
    low, high = found.depth_bounds
    assert low <= 5 <= high
    assert high - low < 0.01
    assert found.mtv_verified


def test_straight_lines_stay_exact() -> None:
    square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
    other = [(x + 2.5, y) for x, y in square]
    found = ask(scene(sheet(square), sheet(other)), clearance=1.0)
    assert (found.relation, found.quality, found.distance) == ("near", "exact", 0.5)
    assert found.distance_bounds is None
    other = [(x + 1.5, y) for x, y in square]
    found = ask(scene(sheet(square), sheet(other)), depth=True)
    assert (found.quality, found.depth, found.exact_relation) == ("exact", 0.5, "penetrating")
