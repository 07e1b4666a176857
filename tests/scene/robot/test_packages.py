"""Where the meshes of a URDF are looked for, and what it cannot reach by itself."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.scene import Refused
from satcheck.scene.access import ANYWHERE
from satcheck.scene.robot import FilePlaces
from tests.scene.hostile import needs_links


@pytest.fixture(autouse=True)
def _no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


def file(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("")
    return path


def refusal(places: FilePlaces, uri: str) -> tuple[str, str]:
    with pytest.raises(Refused) as caught:
        places.locate(uri)
    return caught.value.code, caught.value.message


def places(folder: Path, **options: object) -> FilePlaces:
    return FilePlaces(str(folder / "arm.urdf"), **options)  # type: ignore[arg-type]


def test_beside_the_urdf(tmp_path: Path) -> None:
    mesh = file(tmp_path / "meshes" / "a b.stl")
    assert places(tmp_path).locate("meshes/a b.stl") == mesh
    assert places(tmp_path).locate("./meshes/../meshes/a b.stl") == mesh
    assert places(tmp_path).locate(str(mesh)) == mesh
    assert places(tmp_path).locate(f"file://{tmp_path}/meshes/a%20b.stl") == mesh
    code, message = refusal(places(tmp_path), "meshes/b.stl")
    assert code == "missing-resource"
    assert str(tmp_path / "meshes") in message


def test_relative_paths_stay_relative(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file(tmp_path / "arm" / "urdf" / "a.stl")
    file(tmp_path / "arm" / "package.xml")
    monkeypatch.chdir(tmp_path / "arm")
    assert FilePlaces("urdf/r.urdf").locate("a.stl") == Path("urdf/a.stl")
    assert FilePlaces("urdf/r.urdf").locate("package://arm/urdf/a.stl") == Path("urdf/a.stl")


def test_without_a_package_xml_the_package_is_the_folder_around_that_of_the_urdf(
    tmp_path: Path,
) -> None:
    mesh = file(tmp_path / "arm" / "meshes" / "a.stl")
    urdf = tmp_path / "arm" / "urdf"
    urdf.mkdir()
    for uri in ("../meshes/a.stl", str(mesh), f"file://{mesh}", "package://arm/meshes/a.stl"):
        assert places(urdf).locate(uri) == mesh


def test_file_paths_may_start_in_a_folder_above(tmp_path: Path) -> None:
    folder = tmp_path / "models" / "box"
    mesh = file(folder / "meshes" / "a.stl")
    file(tmp_path / "package.xml")
    assert places(folder).locate("file://models/box/meshes/a.stl") == mesh
    assert refusal(places(folder), "models/box/meshes/a.stl")[0] == "missing-resource"
    file(folder / "model.config")
    other = file(tmp_path / "models" / "other.stl")
    assert refusal(places(folder), "file://models/other.stl")[0] == "outside-path"
    assert places(folder, permitted=ANYWHERE).locate("file://models/other.stl") == other


@needs_links
def test_a_link_to_the_folder_of_a_urdf_leads_to_its_meshes(tmp_path: Path) -> None:
    file(tmp_path / "real" / "arm" / "a.stl")
    file(tmp_path / "real" / "b.stl")
    linked = tmp_path / "assets" / "arm"
    linked.parent.mkdir()
    linked.symlink_to(tmp_path / "real" / "arm")
    assert places(linked).locate("a.stl") == linked / "a.stl"
    assert refusal(places(linked), str(tmp_path / "real" / "b.stl"))[0] == "outside-path"


def test_outside_its_package_a_urdf_opens_nothing_by_itself(tmp_path: Path) -> None:
    mesh = file(tmp_path / "meshes" / "a.stl")
    urdf = tmp_path / "arm" / "urdf"
    urdf.mkdir(parents=True)
    (urdf / "link.stl").symlink_to(mesh)
    for uri in ("../../meshes/a.stl", str(mesh), f"file://{mesh}", "link.stl"):
        code, message = refusal(places(urdf), uri)
        assert code == "outside-path"
        assert str(tmp_path / "arm") in message
        assert "--allow-outside" in message
        assert "or with a package.xml in the folder that holds both" in message
        assert places(urdf, permitted=ANYWHERE).locate(uri).samefile(mesh)


def test_a_package_xml_is_the_border_however_near(tmp_path: Path) -> None:
    mesh = file(tmp_path / "meshes" / "a.stl")
    file(tmp_path / "arm" / "package.xml")
    assert refusal(places(tmp_path / "arm"), "../meshes/a.stl")[0] == "outside-path"
    file(tmp_path / "package.xml")
    (tmp_path / "arm" / "package.xml").unlink()
    assert places(tmp_path / "arm" / "urdf" / "old").locate("../../../meshes/a.stl") == mesh


def test_the_root_of_the_file_system_is_no_package() -> None:
    assert FilePlaces("/x/r.urdf")._root == Path("/x")


MANIFEST = '<?xml version="1.0"?><package format="2"><name> arm_description </name></package>'


@pytest.mark.parametrize("manifest", [MANIFEST, f"<!-- a name -->{MANIFEST[21:]}"])
def test_a_package_has_the_name_that_it_gives_itself(tmp_path: Path, manifest: str) -> None:
    mesh = file(tmp_path / "arm-main" / "meshes" / "a.stl")
    (tmp_path / "arm-main" / "package.xml").write_text(manifest)
    urdf = tmp_path / "arm-main" / "urdf"
    urdf.mkdir()
    assert places(urdf).locate("package://arm_description/meshes/a.stl") == mesh
    assert refusal(places(urdf), "package://other/meshes/a.stl")[0] == "missing-resource"
    (tmp_path / "arm-main" / "package.xml").write_text("<package><name>arm_desc")
    assert refusal(places(urdf), "package://arm_description/meshes/a.stl")[0] == "missing-resource"


def test_ros_packages_have_the_names_that_they_give_themselves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mesh = file(tmp_path / "ws" / "arm-main" / "a.stl")
    (tmp_path / "ws" / "arm-main" / "package.xml").write_text(MANIFEST)
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"{tmp_path / 'gone'}:{tmp_path / 'ws'}")
    urdf = tmp_path / "a" / "b"
    urdf.mkdir(parents=True)
    assert places(urdf).locate("package://arm_description/a.stl") == mesh


def test_windows_separators_and_quoted_spaces(tmp_path: Path) -> None:
    mesh = file(tmp_path / "arm" / "meshes" / "a b.stl")
    urdf = tmp_path / "arm" / "urdf"
    urdf.mkdir()
    for uri in (
        "..\\meshes\\a b.stl",
        "package://arm\\meshes\\a b.stl",
        "package://arm/meshes/a%20b.stl",
    ):
        assert places(urdf).locate(uri) == mesh


def test_a_file_that_is_there_as_it_is_written_counts(tmp_path: Path) -> None:
    mesh = file(tmp_path / "a%20b.stl")
    file(tmp_path / "a b.stl")
    assert places(tmp_path).locate("package://x/a%20b.stl".replace("x", tmp_path.name)) == mesh


def test_the_package_around_a_urdf_belongs_to_it(tmp_path: Path) -> None:
    mesh = file(tmp_path / "arm" / "meshes" / "a.stl")
    file(tmp_path / "arm" / "package.xml")
    urdf = tmp_path / "arm" / "urdf"
    urdf.mkdir()
    assert places(urdf).locate("../meshes/a.stl") == mesh
    assert places(urdf).locate("package://arm/meshes/a.stl") == mesh
    assert places(urdf).locate("model://arm/meshes/a.stl") == mesh
    assert places(urdf).locate("package:///arm/meshes/a.stl") == mesh


def test_a_package_beside_is_found_but_has_to_be_allowed(tmp_path: Path) -> None:
    mesh = file(tmp_path / "meshes_of_arm" / "a.stl")
    urdf = tmp_path / "arm" / "urdf"
    urdf.mkdir(parents=True)
    uri = "package://meshes_of_arm/a.stl"
    code, message = refusal(places(urdf), uri)
    assert code == "outside-path"
    assert f"allow it: --package meshes_of_arm={mesh.parent}" in message
    assert places(urdf, permitted=ANYWHERE).locate(uri) == mesh
    assert places(urdf, packages={"meshes_of_arm": mesh.parent}).locate(uri) == mesh


@pytest.mark.parametrize(
    ("variable", "entry"),
    [
        ("ROS_PACKAGE_PATH", "ws"),
        ("ROS_PACKAGE_PATH", "ws/arm"),
        ("AMENT_PREFIX_PATH", "prefix"),
    ],
)
def test_ros_says_where_packages_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, variable: str, entry: str
) -> None:
    mesh = file(tmp_path / ("prefix/share/arm" if "AMENT" in variable else "ws/arm") / "a.stl")
    monkeypatch.setenv(variable, str(tmp_path / entry))
    urdf = tmp_path / "elsewhere"
    urdf.mkdir()
    assert places(urdf).locate("package://arm/a.stl") == mesh
    assert refusal(places(urdf), "package://arm/../../secret.stl")[0] == "missing-resource"


def test_the_longest_name_given_counts_and_is_trusted_as_far_as_its_folder(tmp_path: Path) -> None:
    near, far = file(tmp_path / "near" / "a.stl"), file(tmp_path / "far" / "x" / "b.stl")
    urdf = tmp_path / "urdf"
    urdf.mkdir()
    found = places(urdf, packages={"arm": far.parents[1], "arm/meshes/": near.parent})
    assert found.locate("package://arm/meshes/a.stl") == near
    assert found.locate("package://arm/x/b.stl") == far
    assert refusal(found, "package://arm/x/c.stl")[0] == "missing-resource"
    assert refusal(found, "package://arm/../near/a.stl")[0] == "outside-path"


@pytest.mark.parametrize(
    ("uri", "code", "said"),
    [
        ("package://nowhere/a.stl", "missing-resource", "--package nowhere=DIR"),
        ("https://example.org/a.stl", "unsupported-feature", "https:// is not fetched"),
        ("a\0.stl", "bad-record", "NUL"),
        ("$(find arm)/a.stl", "xacro", "expand the file first"),
        ("file://$(find arm)/a.stl", "xacro", "expand the file first"),
        ("meshes/a.stl", "missing-resource", "there is no folder"),
        ("a.stl", "missing-resource", "no such file in /"),
    ],
)
def test_what_is_not_found(tmp_path: Path, uri: str, code: str, said: str) -> None:
    found, message = refusal(places(tmp_path), uri)
    assert found == code
    assert said in message
