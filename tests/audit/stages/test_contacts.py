"""Contacts: only where they are asked for, whole or said to be cut, the same in any order."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from satcheck import core
from satcheck.audit import Settings, check
from satcheck.core.errors import SatcheckError
from satcheck.report.contacts import Contacts, ContactTotals
from tests.audit.shapes import bracket, moved, open_box, scene_of, unit_box

ASKED = Settings(contacts=True, depth=False)


def only(report):
    (finding,) = report.findings
    return finding


def contacts_of(tmp_path, settings=ASKED, **meshes):
    return only(check(scene_of(tmp_path, **meshes), settings))


def stages(finding):
    return [stage.stage for stage in finding.plan]


def test_not_asked_not_found(tmp_path):
    finding = contacts_of(tmp_path, Settings(), a=unit_box(), b=unit_box(0.5))
    assert finding.contacts is None
    assert "contacts" not in stages(finding)


@pytest.mark.parametrize(
    "b", [unit_box(9.0), unit_box(0.25, 0.25, 0.25, 0.5)], ids=["apart", "inside"]
)
def test_asked_and_nothing_there(tmp_path, b):
    """The relation says it already: no stage runs."""
    finding = contacts_of(tmp_path, a=unit_box(), b=b)
    assert finding.contacts == Contacts()
    assert "contacts" not in stages(finding)


def test_convex_bodies_that_cross(tmp_path):
    finding = contacts_of(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25, 0.125))
    (loop,) = finding.contacts.curves
    assert loop.closed
    assert loop.length == 2 * (0.5 + 0.75 + 0.875)
    assert finding.contacts.totals == ContactTotals(1, loop.length, 0, 0.0, 0, 12)
    assert stages(finding) == ["aabb", "obb", "hull", "contacts"]


def test_a_flush_joint(tmp_path):
    finding = contacts_of(tmp_path, a=bracket(), b=moved(bracket(), 2.0, 2.0, 0.0))
    assert finding.relation == "touching"
    areas = {(p.normal, p.opposed): p.area for p in finding.contacts.patches}
    # The notch of one bracket holds the corner of the other: two walls, and both ends flush.
    assert areas[(1.0, 0.0, 0.0), True] == 4 * 4
    assert areas[(0.0, 1.0, 0.0), True] == 4 * 4
    assert not finding.contacts.curves


def test_an_open_mesh_has_contacts_too(tmp_path):
    finding = contacts_of(tmp_path, a=open_box(), b=unit_box(3.5, 1.0, 1.0))
    (loop,) = finding.contacts.curves
    assert (loop.closed, loop.length) == (True, 4.0)


def test_the_touch_band_moves_no_point(tmp_path):
    """Called touching because the tolerance is wide; there is no common point all the same."""
    settings = Settings(contacts=True, tolerance=0.5)
    finding = contacts_of(tmp_path, settings, a=unit_box(), b=unit_box(1.25))
    assert (finding.relation, finding.contacts) == ("touching", Contacts())


def test_the_order_of_the_bodies_changes_no_curve(tmp_path):
    meshes = {"a": bracket(), "b": moved(unit_box(edge=3.0), 1.0, 1.5, 0.5)}
    one = contacts_of(tmp_path, **meshes).contacts
    other = contacts_of(tmp_path, **dict(reversed(meshes.items()))).contacts
    assert one.curves == other.curves
    assert [p.outlines for p in one.patches] == [p.outlines for p in other.patches]


@pytest.mark.parametrize("limit", [0, 5, 6, 7, 11, 12, 1000])
def test_what_is_left_out_is_said(tmp_path, limit):
    """One loop of six points, 12 pairs of triangles."""
    settings = Settings(contacts=True, depth=False, contact_points=limit)
    meshes = {"a": unit_box(), "b": unit_box(0.5, 0.25, 0.125)}
    whole = contacts_of(tmp_path, **meshes).contacts
    cut = contacts_of(tmp_path, settings, **meshes).contacts
    assert cut.totals == whole.totals
    assert len(cut.curves) == (limit >= 6)
    assert len(cut.triangle_pairs) == min(limit, 12)
    assert cut.truncated == (limit < 12)
    assert not whole.truncated


def test_too_many_are_a_warning_not_a_list(tmp_path, monkeypatch):
    monkeypatch.setattr("satcheck.audit.stages.contacts.MAX_TRIANGLE_PAIRS", 11)
    report = check(scene_of(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25, 0.125)), ASKED)
    finding = only(report)
    assert (finding.relation, finding.contacts) == ("penetrating", None)
    assert [stage.result for stage in finding.plan if stage.stage == "contacts"] == ["too many"]
    assert [issue.code for issue in report.issues] == ["too-many-contacts"]


def test_too_many_steps_are_a_warning_too(tmp_path, monkeypatch):
    spent = SimpleNamespace(complete=False, within_budget=False)
    monkeypatch.setattr(core, "surface_intersection", lambda *_: spent)
    report = check(scene_of(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25, 0.125)), ASKED)
    assert only(report).contacts is None
    (issue,) = report.issues
    assert issue.code == "too-many-contacts"
    assert "more steps than a pair may" in issue.message


def test_contacts_need_triangles():
    with pytest.raises(SatcheckError, match="triangles") as caught:
        Settings(contacts=True, accuracy="hull")
    assert caught.value.code == "bad-setting"
