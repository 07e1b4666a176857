"""Models that an SDFormat file includes."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.scene import Refused, load_scene
from satcheck.scene.access import files_read
from tests.plugins.sdf.files import (
    include,
    joint,
    link,
    model,
    origins,
    read,
    refusal,
    sdf,
    world,
    write,
    write_model,
)

CRATE = sdf(model("crate", "<pose>0 0 5 0 0 0</pose>", link("l"), link("tip", "0 0 1 0 0 0")))


def unreadable(folder: Path, text: str) -> list[tuple[str, str, str]]:
    """(id, code, message) of each body that is not read."""
    bodies = load_scene([write(folder, text)]).unreadable
    return [(body.id, body.issue.code, body.issue.message) for body in bodies]


def test_an_include_renames_and_places_the_model(tmp_path: Path) -> None:
    write_model(tmp_path / "models", "crate", CRATE)
    text = world(
        include("model://crate"),
        include("model://crate", "<name>b</name><pose>1 0 0 0 0 0</pose>"),
        include(
            "model://crate",
            "<name>c</name><placement_frame>tip</placement_frame><pose>0 0 9 0 0 0</pose>",
        ),
    )
    assert origins(read(tmp_path, text)[0]) == {
        "crate::l": (0, 0, 5),
        "crate::tip": (0, 0, 6),
        "b::l": (1, 0, 0),
        "b::tip": (1, 0, 1),
        "c::l": (0, 0, 8),
        "c::tip": (0, 0, 9),
    }


def test_where_models_are_looked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here, there = tmp_path / "project", tmp_path / "elsewhere"
    here.mkdir()
    write_model(there, "crate", CRATE)
    for uri in ("model://crate", "crate", "model://crate/model.sdf"):
        ((id_, code, message),) = unreadable(here, world(include(uri)))
        assert (id_, code) == ("crate", "missing-resource"), message
    for uri in ("model://crate", "crate"):
        place = write(here, world(include(uri)))
        by_option = load_scene([place], packages={"crate": there / "crate"})
        assert by_option.order == ("crate::l", "crate::tip")
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(there))
    for uri in ("model://crate", "crate", "model://crate/model.sdf"):
        assert unreadable(here, world(include(uri))) == []


def test_a_bare_name_is_that_of_a_model_beside_or_above(tmp_path: Path) -> None:
    write_model(tmp_path / "models", "crate", CRATE)
    (tmp_path / "worlds").mkdir()
    assert unreadable(tmp_path / "worlds", world(include("crate"))) == []
    deeper = tmp_path / "models" / "stack"
    write_model(tmp_path / "models", "stack", sdf(model("stack", include("crate"))))
    ((_, code, message),) = unreadable(deeper, world(include("crate")))
    assert code == "outside-path"
    assert "--package crate=" in message
    found = load_scene([deeper / "model.sdf"], allow_outside=True)
    assert found.order == ("stack::crate::l", "stack::crate::tip")


def test_a_manifest_names_the_newest_version(tmp_path: Path) -> None:
    write_model(tmp_path, "crate", CRATE)
    names = '<sdf version="1.10">new.sdf</sdf><sdf version="1.9">model.sdf</sdf>'
    (tmp_path / "crate/model.config").write_text(f"<model>{names}</model>")
    (tmp_path / "crate/new.sdf").write_text(sdf(model("new", link("l"))))
    assert list(origins(read(tmp_path, sdf(include("crate")))[0])) == ["new::l"]


def test_a_manifest_leads_to_no_other_folder(tmp_path: Path) -> None:
    folder = tmp_path / "package/worlds"
    write_model(folder, "crate", CRATE)
    (tmp_path / "secret.sdf").write_text(CRATE)
    (folder / "crate/model.config").write_text(
        '<model><sdf version="1.9">../../../secret.sdf</sdf></model>'
    )
    ((_, code, _),) = unreadable(folder, world(include("model://crate")))
    assert code == "outside-path"


@pytest.mark.parametrize(
    ("uri", "id_", "code"),
    [
        (
            "https://fuel.gazebosim.org/1.0/openrobotics/models/Table",
            "Table",
            "unsupported-feature",
        ),
        ("model://nothing", "nothing", "missing-resource"),
        ("model://../../etc", "..", "missing-resource"),
        ("empty", "empty", "missing-resource"),
        ("broken.sdf", "broken.sdf", "bad-record"),
        ("hollow.sdf", "hollow.sdf", "not-this-format"),
    ],
)
def test_what_cannot_be_included_is_a_body_that_is_not_checked(
    tmp_path: Path, uri: str, id_: str, code: str
) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "broken.sdf").write_text("<sdf version='1.9'><model>")
    (tmp_path / "hollow.sdf").write_text("<sdf version='1.9'/>")
    joined = joint("j", f"{id_}::l", "m::a")
    text = world(model("m", link("a")), include(uri), include(uri), joined)
    first, second = unreadable(tmp_path, text)
    assert [first[:2], second[:2]] == [(id_, code), (f"{id_}-2", code)]
    assert repr(uri) in first[2]


def test_nothing_is_relative_to_what_is_not_read(tmp_path: Path) -> None:
    text = model("m", '<pose relative_to="gone::l">0 0 0 0 0 0</pose>', link("a"))
    code, message = refusal(tmp_path, world(include("model://gone"), text))
    assert code == "index-out-of-range"
    assert "'gone::l'" in message


def test_a_file_that_includes_itself(tmp_path: Path) -> None:
    write_model(tmp_path, "a", sdf(model("a", include("model://b"))))
    write_model(tmp_path, "b", sdf(model("b", include("model://a"))))
    with pytest.raises(Exception, match="includes itself") as caught:
        read(tmp_path, world(include("model://a")))
    assert caught.value.code == "reference-cycle"  # type: ignore[attr-defined]


def test_a_merged_model_is_part_of_the_one_around_it(tmp_path: Path) -> None:
    write_model(tmp_path, "crate", CRATE)
    merged = '<include merge="true"><uri>crate</uri><pose>3 0 0 0 0 0</pose></include>'
    text = model("m", link("a"), merged, joint("j", "a", "tip"))
    robot, _ = read(tmp_path, sdf(text))
    assert origins(robot) == {"m::a": (0, 0, 0), "m::l": (3, 0, 0), "m::tip": (3, 0, 1)}


def test_meshes_lie_beside_the_file_that_names_them(tmp_path: Path) -> None:
    mesh = "<collision name='c'><geometry><mesh><uri>m.obj</uri></mesh></geometry></collision>"
    write_model(tmp_path, "crate", sdf(model("crate", link("l", inside=mesh))))
    (tmp_path / "crate/m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    scene = load_scene([write(tmp_path, world(include("crate")))])
    (body,) = scene.bodies
    assert body.file.path == (tmp_path / "crate/m.obj").as_posix()
    assert scene.entries["crate::l"].file == (tmp_path / "crate/model.sdf").as_posix()


def test_the_files_that_are_read_and_looked_for_are_noted(tmp_path: Path) -> None:
    write_model(tmp_path, "crate", CRATE)
    path = write(tmp_path, world(include("crate"), include("other.sdf")))
    with files_read() as noted:
        load_scene([path])
    names = set(noted)
    for name in ("w.sdf", "crate/model.config", "crate/model.sdf", "other.sdf"):
        assert str(tmp_path / name) in names


def test_models_in_each_other_without_end(tmp_path: Path) -> None:
    deep = "<model name='m'>" * 100 + link("a") + "</model>" * 100
    assert refusal(tmp_path, sdf(deep))[0] == "too-large"


def test_a_joint_with_a_link_of_a_model_that_is_not_read(tmp_path: Path) -> None:
    text = model("m", include("model://gone"), link("a"), joint("j", "other::l", "a"))
    robot, (warning,) = read(tmp_path, sdf(text))
    assert robot.joints == ()
    assert (warning.code, "'m::j'" in warning.message) == ("joint-not-moved", True)


def test_merging_into_the_world(tmp_path: Path) -> None:
    inner = model("x", link("a"))
    write_model(tmp_path, "two", sdf(model("two", inner, inner.replace('"x"', '"y"'))))
    write_model(tmp_path, "one", CRATE)
    merged = '<include merge="true"><uri>two</uri><pose>3 0 0 0 0 0</pose></include>'
    scene = load_scene([write(tmp_path, world(merged))])
    assert scene.order == ("x::a", "y::a")
    assert scene.rules == ()
    with pytest.raises(Refused, match="merged into the world"):
        load_scene([write(tmp_path, world(merged.replace("two", "one")))])


def test_a_model_of_a_server_lies_where_the_user_says(tmp_path: Path) -> None:
    write_model(tmp_path / "downloads", "crate", CRATE)
    path = write(tmp_path, world(include("https://example.org/1.0/models/crate")))
    packages = {"example.org/1.0/models": tmp_path / "downloads"}
    assert load_scene([path], packages=packages).order == ("crate::l", "crate::tip")
    ((_, _, message),) = unreadable(tmp_path, path.read_text())
    assert "--package example.org=DIR" in message


@pytest.mark.parametrize("uri", ["http://[::", "://", "model://", "x" * 5000, "file://"])
def test_a_uri_that_leads_nowhere(tmp_path: Path, uri: str) -> None:
    (lost,) = unreadable(tmp_path, world(include(uri)))
    assert lost[1] in ("missing-resource", "unsupported-feature")


@pytest.mark.parametrize("other", [model("b", "", link("l")), "<world name='w'/>"])
def test_what_an_included_file_holds_beside_its_model_is_a_body_that_is_not_read(
    tmp_path: Path, other: str
) -> None:
    write_model(tmp_path / "models", "crate", CRATE.replace("</sdf>", f"{other}</sdf>"))
    ((_, code, message),) = unreadable(tmp_path, world(include("model://crate")))
    assert (code, "only a first model is" in message) == ("unsupported-feature", True)
