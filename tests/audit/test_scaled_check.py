"""Scenes beyond the number range of the core: scaled by a power of two, and reported as given."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from satcheck.audit import Report, Settings, check
from satcheck.core.errors import SatcheckError
from satcheck.report.bodies import Sphere
from satcheck.report.json import render
from satcheck.scene import load_scene
from satcheck.verify import verify
from tests.audit.shapes import Mesh, bracket, moved, open_box, unit_box, write

LIMITS = Path(__file__).resolve().parents[2] / "docs" / "limits.md"
EXPONENTS = [-860, -498, 332, 860]
SHEET: Mesh = ([(-9, -9, 0.5), (9, -9, 0.5), (9, 9, 0.5), (-9, 9, 0.5)], [(0, 1, 2, 3)])
MESHES = {
    "bracket": bracket(),
    "across": moved(bracket(), 1.0, -5.5, 1.0),
    "box": unit_box(1.25, 1.25, 0.125),
    "beside": unit_box(2.25, 1.25, 0.125),
    "boxed": unit_box(1.25, 1.25, 1.375),
    "open": moved(open_box(), 20.0, 0.0, 0.0),
    "in_open": unit_box(21.0, 1.0, 1.0),
    "sheet": SHEET,
}
LENGTHS = {"tolerance", "distance", "depth", "depth_bounds", "mtv", "witness"}
LENGTHS |= {"thickness", "thickness_bounds", "ball"}


def times(value, exponent: int):
    """A length, or what is made of lengths."""
    if isinstance(value, dict):
        return {key: times(member, exponent) for key, member in value.items()}
    if isinstance(value, list):
        return [times(member, exponent) for member in value]
    return None if value is None else math.ldexp(value, exponent)


def larger(mesh: Mesh, exponent: int) -> Mesh:
    points, faces = mesh
    return [tuple(math.ldexp(c, exponent) for c in point) for point in points], faces


def report_at(folder: Path, exponent: int, **settings) -> Report:
    folder.mkdir()
    paths = write(folder, **{name: larger(mesh, exponent) for name, mesh in MESHES.items()})
    rules = folder / "rules.json"
    rule = {"a": "bo*", "b": "sheet", "max_depth": math.ldexp(0.75, exponent)}
    content = {"schema": "satcheck.scene/1", "bodies": [], "rules": [rule]}
    rules.write_text(json.dumps(content), encoding="utf-8")
    tolerance, clearance = (math.ldexp(length, exponent) for length in (2.0**-20, 0.5))
    asked = Settings(tolerance=tolerance, clearance=clearance, depth=True, **settings)
    return check(load_scene([*paths, rules]), asked)


def findings_of(report: Report) -> list[dict]:
    found = json.loads("".join(render(report, timings=False)))["findings"]
    for finding in found:
        finding["rule"] = finding["rule"] and Path(finding["rule"]).name
    return found


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_a_scene_in_another_unit_has_the_same_findings(tmp_path: Path, exponent: int) -> None:
    plain = findings_of(report_at(tmp_path / "plain", 0))
    scaled = findings_of(report_at(tmp_path / "scaled", exponent))
    assert len(plain) == len(scaled) == 28
    for one, other in zip(plain, scaled, strict=True):
        stages = other.pop("plan")
        assert stages[0]["stage"] == "unit"
        reason, scaled_reason = one.pop("reason"), other.pop("reason")
        assert (reason is None) == (scaled_reason is None)
        for key in one.keys() - {"plan"}:
            expected = times(one[key], exponent) if key in LENGTHS else one[key]
            assert other[key] == expected, (one["a"], one["b"], key)
    assert {one["relation"] for one in plain} >= {"penetrating", "touching", "contains", "near"}
    assert {one["severity"] for one in plain} >= {"error", "note"}


@pytest.mark.parametrize("exponent", [-300, 300])
def test_volume_and_contacts_where_float64_holds_them(tmp_path: Path, exponent: int) -> None:
    def pair(folder: Path, exponent: int) -> dict:
        folder.mkdir()
        meshes = {"a": unit_box(), "b": unit_box(0.5, 0.5, 0.5)}
        paths = write(folder, **{name: larger(mesh, exponent) for name, mesh in meshes.items()})
        return findings_of(check(paths, Settings(volume=True, contacts=True)))[0]

    plain, scaled = pair(tmp_path / "plain", 0), pair(tmp_path / "scaled", exponent)
    assert scaled["volume"] == math.ldexp(plain["volume"], 3 * exponent) > 0
    curves = scaled["contacts"]["curves"]
    assert [curve["length"] for curve in curves] == [math.ldexp(3.0, exponent)]
    too_large = pair(tmp_path / "beyond", 2 * exponent)
    assert too_large["volume"] is None
    assert [s["stage"] for s in too_large["plan"] if s["result"] == "left out"] == ["volume"]


@pytest.mark.parametrize("scale", [1e100, 1e-150, 1e-260])
def test_curved_shapes_and_motions(tmp_path: Path, scale: float) -> None:
    (mesh,) = write(tmp_path, mesh=larger(unit_box(), math.frexp(scale)[1]))
    turned = {"position": [0, 0, -3 * scale], "euler": [10, 20, 30]}
    bodies = [
        {"id": "ball", "shape": {"type": "sphere", "radius": scale}},
        {
            "id": "box",
            "shape": {"type": "box", "size": [scale] * 3},
            "position": [1.25 * scale, 0, 0],
        },
        {"id": "mesh", "mesh": mesh.name, **turned},
        {"id": "up", "shape": {"type": "sphere", "radius": scale}, "position": [0, 0, 5 * scale]},
    ]
    motion = [{"bodies": "up", "translation": [0, 0, -4 * scale]}]
    content = {"schema": "satcheck.scene/1", "bodies": bodies, "motion": motion}
    (tmp_path / "s.json").write_text(json.dumps(content), encoding="utf-8")
    report = check(load_scene([tmp_path / "s.json"]), Settings(depth=True, certificate=True))
    found = {(f.a, f.b): f for f in report.findings}
    assert found["ball", "box"].depth == pytest.approx(0.25 * scale, rel=1e-12)
    assert found["ball", "mesh"].relation == "separated"
    sweep = found["ball", "up"].motion
    assert sweep is not None
    assert sweep.relation == "penetrating"
    assert sweep.at[0].value == pytest.approx(3 * scale, rel=1e-6)
    assert report.bodies[0].shape == Sphere(radius=scale)
    assert report.bodies[0].transform is None


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_its_certificates_are_accepted(tmp_path: Path, exponent: int) -> None:
    report = report_at(tmp_path / "scene", exponent, certificate=True)
    certified = {(f.a, f.b) for f in report.findings if f.certificate}
    assert len(certified) >= 25
    checked = verify(json.loads("".join(render(report, timings=False))), Path("/"))
    assert not checked.faults
    assert {(f.a, f.b) for f in checked.findings if f.outcome == "accepted"} == certified


def test_ordinary_bodies_go_first(tmp_path: Path) -> None:
    """One stray file must not take the others' answer."""
    meshes = {"a": unit_box(), "b": unit_box(0.5), "stray": larger(unit_box(), 400)}
    report = check(write(tmp_path, **meshes), Settings())
    relations = {(f.a, f.b): f.relation for f in report.findings}
    assert relations["a", "b"] == "penetrating"
    assert relations["a", "stray"] == relations["b", "stray"] == "indeterminate"
    assert [issue.code for issue in report.issues] == ["unplaceable"]


@pytest.mark.parametrize("scale", [1e270, 1e-270])
def test_the_limits_of_the_page(tmp_path: Path, scale: float) -> None:
    limits = " ".join(LIMITS.read_text("utf-8").split())
    assert "coordinates beyond 1e270, bodies less than 1e-270 across" in limits
    assert "1e85 times as large" in limits
    points, faces = unit_box()
    meshes: dict[str, Mesh] = {
        name: ([tuple(c * scale + by * scale for c in point) for point in points], faces)
        for name, by in (("a", 0.0), ("b", 0.5))
    }
    far = math.frexp(scale)[1] + (-280 if scale > 1 else 280)  # 2e84
    (finding, *_) = check(write(tmp_path, **meshes, c=larger(unit_box(), far))).findings
    assert (finding.a, finding.b, finding.relation) == ("a", "b", "penetrating")
    assert finding.depth == pytest.approx(0.5 * scale, rel=1e-12)


def test_what_no_unit_can_hold_is_refused(tmp_path: Path) -> None:
    meshes = {"a": larger(unit_box(), 1000), "b": larger(unit_box(), -1000), "c": unit_box()}
    meshes["d"] = (
        [(0, 0, 0), (2.0**400, 0, 0), (0, 2.0**400, 0), (0, 0, 5e-324)],
        [(0, 1, 2), (0, 1, 3)],
    )
    scene = load_scene(write(tmp_path, **meshes))
    assert {body.id: body.issue.code for body in scene.unreadable} == dict.fromkeys(
        "abd", "out-of-range"
    )


def test_other_commands_say_that_they_do_not_scale(tmp_path: Path) -> None:
    from satcheck.studies.tradeoff import tradeoff

    scene = load_scene(write(tmp_path, a=larger(unit_box(), 400), b=larger(unit_box(0.5), 400)))
    with pytest.raises(SatcheckError, match="beyond 1e45") as caught:
        tradeoff(scene)
    assert caught.value.code == "out-of-range"


@pytest.mark.parametrize("scale", [1.0, 1e50, 1e-50])
def test_the_gap_that_a_motion_keeps_is_in_the_unit_of_the_scene(
    tmp_path: Path, scale: float
) -> None:
    """The scan proves that the balls stay apart by the clearance, and no more is asked."""
    shape = {"type": "sphere", "radius": scale}
    bodies = [
        {"id": "still", "shape": shape},
        {"id": "moved", "shape": shape, "position": [1.8 * scale, 1.8 * scale, -2 * scale]},
    ]
    motion = [{"bodies": "moved", "translation": [0, 0, 4 * scale]}]
    content = {"schema": "satcheck.scene/1", "bodies": bodies, "motion": motion}
    (tmp_path / "s.json").write_text(json.dumps(content))
    settings = Settings(depth=False, clearance=0.5 * scale)
    sweep = check(load_scene([tmp_path / "s.json"]), settings).findings[0].motion
    assert sweep is not None
    assert sweep.distance_at_least == pytest.approx(0.5 * scale)
