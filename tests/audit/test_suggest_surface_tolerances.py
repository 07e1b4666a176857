"""Surface tolerances that are proposed for the bodies of a scene."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from trimesh import creation

from satcheck.audit.suggest_surface_tolerances import surface_tolerances
from satcheck.report.surface_tolerances import SurfaceTolerancesReport
from satcheck.scene import load_scene

SAGITTA = 5 * (1 - math.cos(math.pi / 24))


def report_of(folder: Path, *bodies: dict[str, object]) -> SurfaceTolerancesReport:
    """bodies: of a scene; `pin.obj` and the hole of `bush.obj` have the radius 5 and 24 facets."""
    creation.cylinder(5, 20, sections=24).export(folder / "pin.obj")
    creation.annulus(5, 8, 20, sections=24).export(folder / "bush.obj")
    creation.cylinder(5, 20, sections=6).export(folder / "nut.obj")
    scene = folder / "scene.json"
    scene.write_text(json.dumps({"schema": "satcheck.scene/1", "bodies": list(bodies)}))
    return surface_tolerances(load_scene([scene]))


def test_a_copy_twice_as_large_is_twice_as_far_off(tmp_path: Path) -> None:
    report = report_of(
        tmp_path,
        {"id": "bush", "mesh": "bush.obj"},
        {"id": "large", "mesh": "bush.obj", "scale": 2, "position": [100, 0, 0]},
    )
    bush, large = report.bodies
    # 0.04278, to the 8 decimals of the file, rounded up to three digits.
    assert bush.surface_tolerance == 0.0428
    assert large.surface_tolerance == report.surface_tolerance == 0.0856
    for body, scale in ((bush, 1), (large, 2)):
        curve = body.curves[0]
        assert curve.concave
        assert curve.sagitta == pytest.approx(scale * SAGITTA, rel=1e-6)
        assert curve.radius == pytest.approx(scale * 5, rel=1e-6)
        assert curve.degrees == pytest.approx(15, rel=1e-6)
        assert (curve.chains, curve.facets) == (1, 24)
    x, y, _ = large.curves[0].place
    assert 9.9 < math.hypot(x - 100, y) < 10


def test_the_facets_of_a_pin_explain_no_overlap(tmp_path: Path) -> None:
    """They are inside the curve, also those of a mirrored copy."""
    mirrored = {"id": "mirrored", "mesh": "pin.obj", "scale": [-1, 1, 1]}
    report = report_of(tmp_path, {"id": "pin", "mesh": "pin.obj"}, mirrored)
    assert report.surface_tolerance is None
    for body in report.bodies:
        assert body.surface_tolerance is None
        assert [curve.concave for curve in body.curves] == [False]
        assert body.curves[0].sagitta == pytest.approx(SAGITTA, rel=1e-6)


def test_a_stretched_copy_is_measured_as_it_is(tmp_path: Path) -> None:
    report = report_of(
        tmp_path,
        {"id": "pin", "mesh": "pin.obj"},
        {"id": "flat", "mesh": "pin.obj", "scale": [1.5, 1, 1]},
    )
    _, flat = report.bodies
    assert flat.curves[0].sagitta == pytest.approx(1.5 * SAGITTA, rel=0.06)


def test_no_curve_no_tolerance(tmp_path: Path) -> None:
    report = report_of(
        tmp_path,
        {"id": "nut", "mesh": "nut.obj"},
        {"id": "ball", "shape": {"type": "sphere", "radius": 1}},
    )
    nut, ball = report.bodies
    assert report.surface_tolerance is None
    assert (nut.surface_tolerance, nut.curves, len(nut.left_out)) == (None, (), 1)
    assert ball.stated
    assert nut.left_out[0].degrees == pytest.approx(60, rel=1e-6)
