"""IFC: the facets of curved surfaces, and how far they may be off."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit import check
from satcheck.audit.settings import Settings
from satcheck.plugins.ifc.readers import CHORD
from satcheck.scene import Scene, load_scene
from tests.plugins.ifc.models import Model
from tests.plugins.ifc.test_reading import codes

OWN = CHORD / 1000  # metres


def read(folder: Path, model: Model, **options: float) -> Scene:
    path = folder / "model.ifc"
    path.write_bytes(model.bytes())
    return load_scene([path], reading=options)


def extruded(model: Model, profile: str, height: float = 2.0) -> str:
    up = model.add("IFCDIRECTION((0.,0.,1.))")
    return model.add(f"IFCEXTRUDEDAREASOLID({model.add(profile)},{model.origin},{up},{height})")


def column(model: Model, radius: float = 0.5, x: float = 0.0) -> str:
    disc = extruded(model, f"IFCCIRCLEPROFILEDEF(.AREA.,$,$,{radius})")
    return model.element(model.shape(disc), (x, 0, 0))


def tolerances(scene: Scene) -> list[float]:
    return [body.facet_tolerance for body in scene.bodies]


def test_only_curved_bodies_have_a_tolerance(tmp_path: Path) -> None:
    model = Model()
    model.box((1, 1, 1), (5, 0, 0))
    column(model)
    assert sorted(tolerances(read(tmp_path, model))) == [0, OWN]
    assert "1 bodies" in codes(read(tmp_path, model))["faceted"]
    assert max(tolerances(read(tmp_path, model, chord_tolerance=0.1))) == 1e-4


@pytest.mark.parametrize(
    ("profile", "curved"),
    [
        ("IFCISHAPEPROFILEDEF(.AREA.,$,$,0.2,0.4,0.01,0.02,$,$,$)", False),
        ("IFCISHAPEPROFILEDEF(.AREA.,$,$,0.2,0.4,0.01,0.02,0.015,$,$)", True),
        ("IFCROUNDEDRECTANGLEPROFILEDEF(.AREA.,$,$,0.2,0.4,0.05)", True),
    ],
)
def test_rounded_profiles_are_curved(tmp_path: Path, profile: str, curved: bool) -> None:
    model = Model()
    model.element(model.shape(extruded(model, profile)))
    assert tolerances(read(tmp_path, model)) == [OWN if curved else 0]


def test_a_round_opening_makes_its_host_curved(tmp_path: Path) -> None:
    model = Model()
    wall = model.box((4, 4, 1), (-2, -2, 0), kind="IFCWALL", more=",$,$")
    disc = extruded(model, "IFCCIRCLEPROFILEDEF(.AREA.,$,$,0.5)")
    hole = model.element(model.shape(disc), kind="IFCOPENINGELEMENT", more=",$,$")
    model.relation("IFCRELVOIDSELEMENT", f"{wall},{hole}")
    assert tolerances(read(tmp_path, model)) == [OWN]


def test_mapped_items_are_curved_as_what_they_repeat(tmp_path: Path) -> None:
    model = Model()
    disc = model.shape(extruded(model, "IFCCIRCLEPROFILEDEF(.AREA.,$,$,0.5)"))
    source = model.add(f"IFCREPRESENTATIONMAP({model.origin},{disc})")
    point = model.add("IFCCARTESIANPOINT((0.,0.,0.))")
    target = model.add(f"IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,{point},1.,$)")
    item = model.add(f"IFCMAPPEDITEM({source},{target})")
    model.element(model.shape(item, kind="MappedRepresentation"))
    assert tolerances(read(tmp_path, model)) == [OWN]


def test_finer_facets_tell_a_thin_overlap_from_a_touch(tmp_path: Path) -> None:
    model = Model()
    column(model)
    column(model, x=0.9995)  # 0.5 mm deep
    for chord, relation in ((1.0, "touching"), (0.01, "penetrating")):
        scene = read(tmp_path, model, chord_tolerance=chord, angular_tolerance=3.0)
        (finding,) = check(scene, Settings(depth=False)).findings
        assert (finding.relation, scene.reading["chord_tolerance"]) == (relation, chord)


@pytest.mark.parametrize("curved", [True, False])
def test_arcs_of_a_polycurve_are_curved(tmp_path: Path, curved: bool) -> None:
    model = Model()
    points = model.add("IFCCARTESIANPOINTLIST2D(((0.,0.),(1.,1.),(2.,0.)))")
    first = "IFCARCINDEX((1,2,3))" if curved else "IFCLINEINDEX((1,2,3))"
    line = model.add(f"IFCINDEXEDPOLYCURVE({points},({first},IFCLINEINDEX((3,1))),.F.)")
    profile = f"IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,{line})"
    model.element(model.shape(extruded(model, profile)))
    assert tolerances(read(tmp_path, model)) == [OWN if curved else 0]
