"""Components of overlaps: only where they are asked for, the thickest first, whichever is A."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from msgspec.structs import replace

from satcheck import core
from satcheck.audit import Settings, check
from satcheck.core.errors import SatcheckError
from satcheck.report.contacts import Components
from tests.audit.shapes import box, bracket, moved, open_box, scene_of, unit_box

ASKED = Settings(components=True, depth=False)


def components_of(tmp_path, settings=ASKED, **meshes):
    (finding,) = check(scene_of(tmp_path, **meshes), settings).findings
    return finding


def stages(finding):
    return [stage.stage for stage in finding.plan]


def test_not_asked_not_found(tmp_path):
    finding = components_of(tmp_path, Settings(), a=unit_box(), b=unit_box(0.5))
    assert finding.components is None
    assert "components" not in stages(finding)


@pytest.mark.parametrize("b", [unit_box(9.0), unit_box(1.0)], ids=["apart", "touching"])
def test_no_overlap_has_no_components(tmp_path, b):
    finding = components_of(tmp_path, a=unit_box(), b=b)
    assert finding.components == Components()
    assert "components" not in stages(finding)


def test_the_corner_of_two_boxes(tmp_path):
    finding = components_of(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25, 0.125))
    assert finding.components.resolved
    (common,) = finding.components.items
    assert common.bounds == ((0.5, 0.25, 0.125), (1.0, 1.0, 1.0))
    assert common.thickness_bounds == pytest.approx((0.5, 0.5), abs=1e-12)
    assert (common.curves, common.curve_length) == (1, 2 * (0.5 + 0.75 + 0.875))
    assert (common.passes, common.volume) == ("none", None)
    assert stages(finding)[-1] == "components"


def test_what_takes_too_long_is_not_resolved(tmp_path, monkeypatch):
    spent = SimpleNamespace(resolved=False, within_limits=False, components=[])
    monkeypatch.setattr(core, "overlap_components", lambda *_: spent)
    monkeypatch.setattr(core, "component_balls", lambda *_: [])
    finding = components_of(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25, 0.125))
    assert (finding.components.items, finding.components.resolved) == ((), False)
    assert finding.plan[-1].result == "not resolved"
    assert "more steps" in finding.plan[-1].detail


def test_volume_where_it_is_asked_for(tmp_path):
    settings = Settings(components=True, depth=False, volume=True)
    finding = components_of(tmp_path, settings, a=bracket(), b=moved(unit_box(), 0.5, 0.5, 0.5))
    (common,) = finding.components.items
    assert common.volume == pytest.approx(finding.volume, abs=1e-9)
    assert common.volume_error < 1e-12


def test_swapped_bodies_have_the_same_components(tmp_path):
    one, other = bracket(), box((5.0, 0.5, -1.0), (5.5, 1.5, 5.0))
    (through,) = components_of(tmp_path, a=one, b=other).components.items
    (swapped,) = components_of(tmp_path, a=other, b=one).components.items
    assert (through.passes, swapped.passes) == ("b-through-a", "a-through-b")
    assert replace(through, passes="none") == replace(swapped, passes="none")


def test_an_open_body_resolves_nothing(tmp_path):
    finding = components_of(tmp_path, a=open_box(), b=unit_box(0.5))
    assert finding.relation == "penetrating"
    assert finding.components == Components(resolved=False)


def test_only_on_triangles():
    with pytest.raises(SatcheckError, match="components needs triangles"):
        Settings(components=True, accuracy="hull")
    with pytest.raises(SatcheckError, match="components needs bodies in space"):
        Settings(components=True, planar="xy")
