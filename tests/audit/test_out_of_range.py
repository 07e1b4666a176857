"""A body out of range is refused by one coded issue, and the other bodies are checked."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from satcheck.audit import Report, Settings, check
from satcheck.audit.axes import axes_of
from satcheck.audit.studied_pair import two_of
from satcheck.audit.tradeoff import tradeoff
from satcheck.cli.output import issue_line
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from tests.audit.shapes import Mesh, box, unit_box, write
from tests.scene import graphs

LARGE = [2.1e44, 1e45, 1e46, 1e300]
SMALL = [9e-46, 1e-46, 1e-300, 5e-324]


def times(mesh: Mesh, scale: float) -> Mesh:
    return [(scale * x, scale * y, scale * z) for x, y, z in mesh[0]], mesh[1]


def report_of(folder: Path, entry: dict[str, Any], **more: Any) -> Report:
    """Of the body `a`, and of two that overlap."""
    write(folder, box=unit_box())
    bodies = [
        {"id": "a", **entry},
        {"id": "b", "mesh": "box.obj"},
        {"id": "c", "mesh": "box.obj", "position": [0.5, 0.5, 0.5]},
    ]
    scene = folder / "scene.json"
    scene.write_text(json.dumps({"schema": "satcheck.scene/1", "bodies": bodies} | more))
    return check(load_scene([scene]))


def require_refused(report: Report, body: str) -> None:
    """The body, and it alone."""
    (issue,) = [issue for issue in report.issues if issue.severity == "error"]
    assert (issue.code, issue.body) == ("out-of-range", body)
    relations = {(f.a, f.b): f.relation for f in report.findings}
    assert relations == {
        ("a", "b"): "indeterminate",
        ("a", "c"): "indeterminate",
        ("b", "c"): "penetrating",
    }


@pytest.mark.parametrize("scale", [*LARGE, *SMALL])
def test_a_mesh_file(tmp_path: Path, scale: float) -> None:
    meshes = {"a": times(unit_box(), scale), "b": unit_box(), "c": unit_box(0.5)}
    require_refused(check(write(tmp_path, **meshes)), "a")


@pytest.mark.parametrize("scale", [*LARGE, *SMALL])
def test_the_scale_of_a_body(tmp_path: Path, scale: float) -> None:
    require_refused(report_of(tmp_path, {"mesh": "box.obj", "scale": scale}), "a")


@pytest.mark.parametrize("place", LARGE)
def test_the_place_of_a_body(tmp_path: Path, place: float) -> None:
    entry = {"mesh": "box.obj", "position": [0, -place, 0]}
    require_refused(report_of(tmp_path, entry), "a")


@pytest.mark.parametrize("size", [*LARGE, *SMALL])
@pytest.mark.parametrize(
    ("kind", "sizes"),
    [
        ("box", {"size": [1.0, 1.0, None]}),
        ("sphere", {"radius": None}),
        ("cylinder", {"radius": None, "height": 1.0}),
        ("capsule", {"radius": 1.0, "length": None}),
        ("cone", {"radius": 1.0, "height": None}),
        ("ellipsoid", {"radii": [1.0, None, 1.0]}),
    ],
)
def test_the_size_of_a_shape(tmp_path: Path, size: float, kind: str, sizes: dict[str, Any]) -> None:
    if kind in ("box", "cone", "capsule"):
        size *= 2 if size > 1 else 1  # a whole size: the shape reaches half as far
    shape = json.loads(json.dumps({"type": kind} | sizes).replace("null", repr(size)))
    require_refused(report_of(tmp_path, {"shape": shape}), "a")


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ({"shape": {"type": "sphere", "radius": 1e200}}, "the sphere has a size of 1e+200"),
        ({"shape": {"type": "sphere", "radius": 1.00002e45}}, "has a size of 1.00002e+45, out"),
        (
            {"shape": {"type": "box", "size": [1, 1, 1]}, "position": [0, 0, 2.0001e44]},
            "the body reaches 2.0001e+44, and world coordinates may be up to 2e+44",
        ),
    ],
)
def test_the_message_names_the_body_and_what_the_limit_is_told_from(
    tmp_path: Path, entry: dict[str, Any], said: str
) -> None:
    report = report_of(tmp_path, entry)
    (line,) = [issue_line(issue) for issue in report.issues if issue.severity == "error"]
    assert line.startswith("error: a: ")
    assert said in line


@pytest.mark.parametrize("scale", [*LARGE, *SMALL])
def test_the_node_of_a_glb_file(tmp_path: Path, scale: float) -> None:
    nodes = [
        {"name": "a", "mesh": 0, "scale": [scale] * 3},
        {"name": "b", "mesh": 0},
        {"name": "c", "mesh": 0, "translation": [0.25, 0.25, 0.25]},
    ]
    (tmp_path / "s.glb").write_bytes(graphs.glb(nodes))
    require_refused(check([tmp_path / "s.glb"]), "a")


@pytest.mark.parametrize("scale", [1e44, 1e-45, 1e-44])
def test_at_the_ends_of_the_range(tmp_path: Path, scale: float) -> None:
    meshes = {"a": times(unit_box(), scale), "b": times(unit_box(0.5), scale)}
    (finding,) = check(write(tmp_path, **meshes), Settings(depth=True, clearance=scale)).findings
    assert finding.relation == "penetrating"
    assert finding.depth == pytest.approx(0.5 * scale)
    apart = {"a": times(unit_box(), scale), "b": times(unit_box(-1.75), scale)}
    (finding,) = check(write(tmp_path, **apart), Settings(clearance=scale)).findings
    assert (finding.relation, finding.distance) == ("near", pytest.approx(0.75 * scale))


def test_a_body_and_one_at_the_far_end_of_the_range(tmp_path: Path) -> None:
    meshes = {"a": times(unit_box(-0.5, -0.5, -0.5), 4e44), "b": times(unit_box(), 1e-45)}
    (finding,) = check(write(tmp_path, **meshes), Settings(depth=True)).findings
    assert finding.relation == "contains"
    assert finding.depth == pytest.approx(2e44)


def test_one_short_edge_is_no_matter_of_range(tmp_path: Path) -> None:
    points, faces = unit_box()
    thin = [(x, y, 5e-324 * z) for x, y, z in points]
    report = check(write(tmp_path, a=(thin, faces), b=unit_box(0.5, 0.5)))
    assert [finding.relation for finding in report.findings] == ["touching"]
    assert not [issue for issue in report.issues if issue.code == "out-of-range"]


@pytest.mark.parametrize("name", ["clearance", "tolerance", "surface_tolerance"])
@pytest.mark.parametrize("length", [1.1e45, 1e50, 1e300])
def test_a_length_of_the_check(name: str, length: float) -> None:
    with pytest.raises(SatcheckError, match=name) as caught:
        Settings(**{name: length})
    assert caught.value.code == "out-of-range"


@pytest.mark.parametrize("name", ["clearance", "tolerance", "max_depth", "max_thickness"])
def test_a_length_of_a_rule(tmp_path: Path, name: str) -> None:
    with pytest.raises(SatcheckError, match=name) as caught:
        report_of(tmp_path, {"mesh": "box.obj"}, rules=[{"a": "a", "b": "b", name: 1e46}])
    assert caught.value.code == "out-of-range"


@pytest.mark.parametrize("length", [0.0, 5e-324, 1e-60])
def test_the_shortest_lengths_are_lengths(tmp_path: Path, length: float) -> None:
    settings = Settings(clearance=length, tolerance=length)
    (finding,) = check(write(tmp_path, a=unit_box(), b=unit_box(1.0)), settings).findings
    assert finding.relation == "touching"


@pytest.mark.parametrize("size", [5e-324, 1e-200, 1e-50])
def test_an_overlap_below_the_range(tmp_path: Path, size: float) -> None:
    """Two boxes of ordinary size, which share a corner."""
    meshes = {"a": box((-1, -1, -1), (size, size, size)), "b": unit_box()}
    settings = Settings(components=True, contacts=True, volume=True, tolerance=0.0)
    (finding,) = check(write(tmp_path, **meshes), settings).findings
    assert finding.relation == "penetrating"
    assert finding.components
    (component,) = finding.components.items
    assert component.thickness_bounds
    low, high = component.thickness_bounds
    assert low <= size <= high


def test_other_questions_about_a_pair(tmp_path: Path) -> None:
    (path,) = write(tmp_path, box=unit_box())
    bodies = [
        {"id": "a", "mesh": path.name, "position": [1e46, 0, 0]},
        {"id": "b", "mesh": path.name},
    ]
    file = tmp_path / "scene.json"
    file.write_text(json.dumps({"schema": "satcheck.scene/1", "bodies": bodies}))
    scene = load_scene([file])
    with pytest.raises(SatcheckError) as of_tradeoff:
        tradeoff(two_of(scene, None))
    with pytest.raises(SatcheckError) as of_axes:
        axes_of(scene)
    for caught in (of_tradeoff, of_axes):
        assert (caught.value.code, caught.value.body) == ("out-of-range", "a")
