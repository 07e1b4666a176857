"""Elements of 3MF models that no specification knows, and those of undeclared prefixes."""

from __future__ import annotations

import pytest

from tests.scene import files
from tests.scene.loading import load, loaded, refusal, warnings

CUBE = files.object_3mf(1)
ITEM = '<item objectid="1"/>'


def package(resources: str = CUBE, items: str = ITEM, **keys: str) -> bytes:
    return files.package_3mf({"3D/3dmodel.model": files.model_3mf(resources, items, **keys)})


@pytest.mark.parametrize(
    "content",
    [
        package(CUBE + '<my:settings speed="3"><my:nozzle/></my:settings>'),
        package(CUBE.replace("<triangle ", '<triangle my:paint="4" ')),
        package(f'<my:group id="9"><multi pindices="0"/></my:group>{CUBE}'),
        package(f'<my:config xmlns="urn:other"><vertex/></my:config>{CUBE}'),
    ],
)
def test_undeclared_prefixes_outside_of_geometry(tmp_path, content):
    file = loaded(tmp_path, "a.3mf", content)
    assert warnings(file) == {}
    assert file.health.volume == 1.0


@pytest.mark.parametrize("coding", ["utf-8", "utf-16"])
def test_undeclared_prefixes_behind_a_comment(tmp_path, coding):
    model = files.model_3mf(CUBE + "<my:settings/>", ITEM).decode().partition("?>")[2]
    text = f'<?xml version="1.0" encoding="{coding}"?>\n<!-- <model> --> {model}'
    content = files.package_3mf({"3D/3dmodel.model": text.encode(coding)})
    assert loaded(tmp_path, "a.3mf", content).health.volume == 1.0


@pytest.mark.parametrize(
    "content",
    [
        package(CUBE.replace("<triangles>", "<my:beams/><triangles>")),
        package(CUBE.replace("</object>", "<my:component/></object>")),
        package(items=ITEM + '<my:item objectid="1"/>'),
        package(CUBE.replace("<my:", "<"), attributes='requiredextensions="my"'),
    ],
)
def test_undeclared_prefixes_that_could_be_geometry(tmp_path, content):
    code, message = refusal(tmp_path, "a.3mf", content)
    assert code in ("unsupported-feature", "misspelt")
    assert "my" in message


def test_a_namespace_that_is_only_like_one_that_is_known(tmp_path):
    keys = 'requiredextensions="z" xmlns:z="http://example.org/slice/2015/07"'
    code, message = refusal(tmp_path, "a.3mf", package(attributes=keys))
    assert code == "unsupported-feature"
    assert "example.org" in message


def test_production_paths_beside_undeclared_prefixes(tmp_path):
    reference = (
        '<component objectid="1" p:path="/3D/other.model" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>'
    )
    model = files.model_3mf(
        files.components_3mf(2, reference) + "<my:settings/>", '<item objectid="2"/>'
    )
    other = files.model_3mf(CUBE, "")
    content = files.package_3mf({"3D/3dmodel.model": model, "3D/other.model": other})
    assert loaded(tmp_path, "a.3mf", content).mesh.bounds == ((5, 0, 0), (6, 1, 1))


@pytest.mark.parametrize(
    "content",
    [
        package(CUBE.replace("<triangle ", "<trianlge ", 1)),
        package(CUBE.replace("<vertex ", "<Vertex ", 1)),
        package(items=ITEM + '<items objectid="1"/>'),
    ],
)
def test_a_misspelt_element_could_be_geometry(tmp_path, content):
    code, message = refusal(tmp_path, "a.3mf", content)
    assert code == "misspelt"
    assert "did you mean" in message


SLICES = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07"
PLACED = f'xmlns:x="http://example.com/x" xmlns:s="{SLICES}"'


@pytest.mark.parametrize(
    "content",
    [
        package(CUBE.replace("<object ", '<object my:hidden="no" ')),
        package(CUBE.replace("<object ", '<object s:slicestackid="10" '), attributes=PLACED),
        package(CUBE.replace("<mesh>", "<x:more/><mesh>"), attributes=PLACED),
        package(CUBE.replace("<triangles>", "<x:more/><triangles>"), attributes=PLACED),
        package(items=ITEM + "<x:item/>", attributes=PLACED),
        package(items='<item objectid="1" x:offset="1 0 0"/>', attributes=PLACED),
        package(items='<item objectid="1" offset="1 0 0"/>'),
        package(CUBE.replace("<mesh>", '<metadata name="cura:cutting_mesh">True</metadata><mesh>')),
    ],
)
def test_what_nobody_knows_blocks_a_pass(tmp_path, content):
    assert set(warnings(loaded(tmp_path, "a.3mf", content))) == {"unread"}


@pytest.mark.parametrize(
    "content",
    [
        package(items='<item objectid="1" trnsform="1 0 0 0 1 0 0 0 1 5 0 0"/>'),
        package(attributes='units="inch"'),
    ],
)
def test_a_misspelt_attribute_is_refused(tmp_path, content):
    assert refusal(tmp_path, "a.3mf", content)[0] == "misspelt"


@pytest.mark.parametrize("unit", ["milimeter", "inches", "mm", ""])
def test_an_unknown_unit_is_refused(tmp_path, unit):
    code, message = refusal(tmp_path, "a.3mf", package(attributes=f'unit="{unit}"'))
    assert code == "bad-record"
    assert "millimeter" in message


def test_an_object_without_a_place_is_a_note(tmp_path):
    scene = load(tmp_path, "a.3mf", package(CUBE + files.object_3mf(2)))
    (issue,) = scene.issues
    assert (issue.code, issue.severity) == ("left-out", "note")
    assert "object '2' not in the build" in issue.message


FAR = [(x + 5, y, z) for x, y, z in files.CUBE_POINTS]
TWO = files.object_3mf(
    1, files.CUBE_POINTS + FAR, files.CUBE + [(a + 8, b + 8, c + 8) for a, b, c in files.CUBE]
)


def prusa(kind: str, *, key: str = "volume_type") -> bytes:
    """Two cubes in one object; the second one is a volume of this kind."""
    config = (
        '<config><object id="1"><volume firstid="0" lastid="11"/><volume firstid="12" lastid="23">'
        f'<metadata type="volume" key="{key}" value="{kind}"/></volume></object></config>'
    )
    return with_config(TWO, ITEM, "Metadata/Slic3r_PE_model.config", config)


def bambu(kind: str) -> bytes:
    """Two components in one object; the second one is a part of this kind."""
    moved = '<component objectid="2" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>'
    parts = '<component objectid="1"/>' + moved
    resources = CUBE + files.object_3mf(2) + files.components_3mf(3, parts)
    config = (
        '<config><object id="3"><part id="1" subtype="normal_part"/>'
        f'<part id="2" subtype="{kind}"/></object></config>'
    )
    return with_config(resources, '<item objectid="3"/>', "Metadata/model_settings.config", config)


def with_config(resources: str, items: str, name: str, config: str) -> bytes:
    model = files.model_3mf(resources, items)
    return files.package_3mf({"3D/3dmodel.model": model, name: config.encode()})


@pytest.mark.parametrize(
    "content",
    [
        prusa("ParameterModifier"),
        prusa("SupportBlocker"),
        prusa("1", key="modifier"),
        bambu("modifier_part"),
        bambu("support_enforcer"),
    ],
)
def test_a_modifier_of_a_slicer_is_no_body(tmp_path, content):
    scene = load(tmp_path, "a.3mf", content)
    (body,) = scene.bodies
    assert body.file.mesh.bounds == ((0, 0, 0), (1, 1, 1))
    assert "left-out" in {issue.code for issue in scene.issues}


@pytest.mark.parametrize("content", [prusa("ModelPart"), bambu("normal_part")])
def test_a_part_of_a_slicer_is_material(tmp_path, content):
    assert loaded(tmp_path, "a.3mf", content).mesh.bounds == ((0, 0, 0), (6, 1, 1))


@pytest.mark.parametrize(
    "content",
    [prusa("NegativeVolume"), bambu("negative_part"), prusa("Unheard"), bambu("unheard_part")],
)
def test_an_object_with_a_negative_volume_cannot_be_checked(tmp_path, content):
    code, _ = refusal(tmp_path, "a.3mf", content)
    assert code == "unsupported-feature"


def test_an_object_with_two_meshes_is_refused(tmp_path):
    mesh = CUBE[CUBE.index("<mesh>") : CUBE.index("</mesh>") + len("</mesh>")]
    code, message = refusal(tmp_path, "a.3mf", package(CUBE.replace("</mesh>", f"</mesh>{mesh}")))
    assert (code, "two <mesh>" in message) == ("bad-record", True)
