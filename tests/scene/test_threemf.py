"""Elements of 3MF models that no specification knows, and those of undeclared prefixes."""

from __future__ import annotations

import io
import zipfile

import pytest

from satcheck.scene.access import Most
from satcheck.scene.errors import Refused
from satcheck.scene.files import zip_guard
from tests.scene import files
from tests.scene.loading import load, loaded, refusal, warnings

CUBE = files.object_3mf(1)
ITEM = '<item objectid="1"/>'
MOST = Most(1 << 20, "the most of a test")
SLICES = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07"
CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PLACED = (
    f'xmlns:x="http://example.com/x" xmlns:s="{SLICES}" '
    'xmlns:d="http://schemas.3mf.io/3dmanufacturing/displacement/2023/10" '
    'xmlns:mc="http://schemas.openxmlformats.org/markup-compatibility/2006"'
)
PARENT = CUBE + files.components_3mf(2, '<component objectid="1"/>')
AWAY = '<item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>'
SECOND = '<item objectid="2"/>'


def package(resources: str = CUBE, items: str = ITEM, **keys: str) -> bytes:
    return files.package_3mf({"3D/3dmodel.model": files.model_3mf(resources, items, **keys)})


def inside(tag: str, child: str) -> str:
    """The first element of that name in the cube or in the build, with a child."""
    text = ITEM if tag == "item" else CUBE
    end = text.index("/>", text.index(f"<{tag} "))
    return f"{text[:end]}>{child}</{tag}>{text[end + 2 :]}"


@pytest.mark.parametrize(
    "content",
    [
        package(CUBE + '<my:settings speed="3"><my:nozzle/></my:settings>'),
        package(CUBE.replace("<triangle ", '<triangle slic3rpe:mmu_segmentation="4" ')),
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
        package(CUBE.replace("</object>", "<my:component/></object>")),
        package(CUBE.replace("<my:", "<"), attributes='requiredextensions="my"'),
    ],
)
def test_undeclared_prefixes_that_could_be_geometry(tmp_path, content):
    code, message = refusal(tmp_path, "a.3mf", content)
    assert code in ("unsupported-feature", "misspelt")
    assert "my" in message


@pytest.mark.parametrize(
    ("content", "name"),
    [
        (package(CUBE.replace("<triangles>", "<my:beams/><triangles>")), "my:beams"),
        (package(items=ITEM + '<my:item objectid="1"/>'), "my:item"),
        (
            package(CUBE.replace("</mesh>", '<beamlattice xmlns="urn:other"/></mesh>')),
            "urn:other:beamlattice",
        ),
    ],
)
def test_what_could_be_geometry_beside_a_mesh_blocks_a_pass(tmp_path, content, name):
    file = loaded(tmp_path, "a.3mf", content)
    assert f"{name} is not read" in warnings(file)["unread"]


ROWS = '<vertex x="9" y="9" z="9"/><vertex x="9" y="9" z="9"/><vertex x="9" y="9" z="9"/>'


@pytest.mark.parametrize(
    "rows",
    [
        f"<!-- {ROWS} -->",
        f"<![CDATA[{ROWS}]]>",
        f'<x xmlns="urn:other">{ROWS}</x>',
        '<satcheck-rows n="0"/>',
        f"<?other {ROWS} <vertex x='8' y='8' z='8'/>?>",
    ],
)
def test_rows_that_are_none_of_the_mesh(tmp_path, rows):
    content = package(CUBE.replace("</vertices>", f"{rows}</vertices>"))
    assert loaded(tmp_path, "a.3mf", content).mesh.bounds == ((0, 0, 0), (1, 1, 1))


def test_rows_with_colours(tmp_path):
    pieces = CUBE.split("/>")
    for k in range(8, 20):  # the triangles
        pieces[k] += (' pid="5" p1="0" p2="1"', ' pid="5"', "")[k % 3]
    file = loaded(tmp_path, "a.3mf", package("/>".join(pieces)))
    assert (file.health.volume, warnings(file)) == (1.0, {})


def test_rows_outside_of_an_object(tmp_path):
    code, message = refusal(tmp_path, "a.3mf", package(ROWS + CUBE))
    assert (code, "geometry outside of an object" in message) == ("bad-record", True)


def test_the_line_of_what_follows_rows(tmp_path):
    cube = CUBE.replace("/>", "/>\n").replace("</object>", "<offset/></object>")
    line = cube.partition("<offset/>")[0].count("\n") + 1
    warned = warnings(loaded(tmp_path, "a.3mf", package(cube)))
    assert f"line {line}: <object>: offset is not read" in warned["unread"]


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


def two_parts(
    root: str, other: str, item: str = '<item objectid="1" p:path="/3D/other.model"/>', **keys: str
) -> bytes:
    """A package whose build places object 1 of another part."""
    model = files.model_3mf(CUBE, item, attributes=root)
    inner = files.model_3mf(CUBE, "", attributes=other)
    return files.package_3mf({"3D/3dmodel.model": model, "3D/other.model": inner}, **keys)


@pytest.mark.parametrize(
    ("root", "other"),
    [('unit="inch"', 'unit="meter"'), ('unit="inch"', ""), ("", 'unit="micron"')],
)
def test_an_object_in_a_part_of_another_unit_is_refused(tmp_path, root, other):
    code, message = refusal(tmp_path, "a.3mf", two_parts(root, other))
    assert (code, "in the unit" in message) == ("unsupported-feature", True)


def test_a_part_of_the_same_unit_that_is_not_written(tmp_path):
    assert loaded(tmp_path, "a.3mf", two_parts("", 'unit="millimeter"')).health.volume == 1.0


def test_a_path_whose_prefix_is_not_declared_is_followed(tmp_path):
    item = '<item objectid="1" p:path="/3D/other.model"/>'
    model = files.model_3mf(CUBE, item).replace(b"xmlns:p=", b"xmlns:q=")
    far = [(x + 5, y, z) for x, y, z in files.CUBE_POINTS]
    other = files.model_3mf(files.object_3mf(1, far), "")
    content = files.package_3mf({"3D/3dmodel.model": model, "3D/other.model": other})
    assert loaded(tmp_path, "a.3mf", content).mesh.bounds == ((5, 0, 0), (6, 1, 1))


def more(content: bytes, **parts: str) -> bytes:
    """A package with further parts, by their names."""
    stream = io.BytesIO(content)
    with zipfile.ZipFile(stream, "a") as archive:
        for name, text in parts.items():
            archive.writestr(name, text)
    return stream.getvalue()


@pytest.mark.parametrize(
    "name",
    [
        "3D/3dmodel.model",
        "3D/3DModel.model",
        "/3D/3dmodel.model",
        "3D/3dmodel%2Emodel",
        "_rels/.rels",
    ],
)
@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_two_parts_of_one_name_are_refused(tmp_path, name):
    code, message = refusal(tmp_path, "a.3mf", more(package(), **{name: "<model/>"}))
    assert (code, "two parts" in message) == ("bad-record", True)


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_two_pictures_of_one_name_are_harmless(tmp_path):
    content = more(more(package(), **{"Metadata/a.png": ""}), **{"Metadata/a.png": ""})
    assert warnings(loaded(tmp_path, "a.3mf", content)) == {}


def test_a_part_that_nothing_names_is_a_note(tmp_path):
    scene = load(tmp_path, "a.3mf", more(package(), **{"3D/other.model": ""}))
    (issue,) = scene.issues
    assert (issue.code, "3D/other.model" in issue.message) == ("left-out", True)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("3dmodel", "3dmodell", "unread"),
        ("Type=", "Tpye=", "misspelt"),
        ("<Relationship ", "<Relationshp ", "misspelt"),
        ("<Relationship ", '<Relationship TargetMode="External" ', "unsupported-feature"),
    ],
)
def test_a_start_part_that_is_not_read_is_named(tmp_path, old, new, code):
    start = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
    line = f'<Relationship Id="r" Type="{start}" Target="/3D/other.model"/>'
    rels = f"<Relationships>{line.replace(old, new, 1)}</Relationships>"
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr("_rels/.rels", rels)
        for name in ("3D/3dmodel.model", "3D/other.model"):
            archive.writestr(name, files.model_3mf(CUBE, ITEM))
    if code == "unread":
        scene = load(tmp_path, "a.3mf", content.getvalue())
        assert [issue.code for issue in scene.issues] == ["unread", "unread", "left-out"]
    else:
        assert refusal(tmp_path, "a.3mf", content.getvalue())[0] == code


def test_a_package_that_states_no_start_part_is_named(tmp_path):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        other = '<Relationship Id="r" Type="http://example.com/start" Target="/3D/other.xml"/>'
        archive.writestr("_rels/.rels", f"<Relationships>{other}</Relationships>")
        archive.writestr("3D/3dmodel.model", files.model_3mf(CUBE, ITEM))
    assert set(warnings(loaded(tmp_path, "a.3mf", content.getvalue()))) == {"unread"}


@pytest.mark.parametrize("tag", ["vertices", "triangles", "components"])
def test_a_list_that_an_object_has_twice_is_refused(tmp_path, tag):
    component = files.components_3mf(2, '<component objectid="1"/>')
    twice = CUBE + component.replace(f"</{tag}>", f"</{tag}><{tag}/>")
    twice = twice.replace(f"</{tag}><triangles>", f"</{tag}><{tag}/><triangles>")
    twice = twice.replace(f"</{tag}></mesh>", f"</{tag}><{tag}/></mesh>")
    code, message = refusal(tmp_path, "a.3mf", package(twice, items='<item objectid="2"/>'))
    assert (code, f"two <{tag}>" in message) == ("bad-record", True)


@pytest.mark.parametrize("kind", ["solidsupport", "support", "surface"])
def test_an_object_of_a_type_of_the_specification(tmp_path, kind):
    content = package(CUBE.replace('type="model"', f'type="{kind}"'))
    assert warnings(loaded(tmp_path, "a.3mf", content)) == {}


@pytest.mark.parametrize("name", ["basematerials", "colorgroup", "x:thing", "m:colorgroup"])
def test_a_resource_that_no_object_names_is_harmless(tmp_path, name):
    keys = PLACED + ' xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"'
    content = package(CUBE + f'<{name} id="9"/>', attributes=keys)
    assert warnings(loaded(tmp_path, "a.3mf", content)) == {}


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
        package(CUBE.replace("<triangle ", '<triangle my:paint="4" ')),
        package(CUBE.replace("<vertex ", '<vertex dx="4" ')),
        package(CUBE.replace("<triangle ", '<triangle v4="4" ')),
        package(CUBE.replace("<triangle ", '<triangle x:d1="4" '), attributes=PLACED),
        package(CUBE.replace("<mesh>", '<mesh scale="20">')),
        package(CUBE.replace("<vertices>", '<vertices x:offset="20">'), attributes=PLACED),
        package(CUBE.replace('type="model"', 'type="modle"')),
        package(CUBE.replace('type="model"', 'type="other"')),
        package(CUBE + "<volume/>"),
        package(CUBE.replace("<mesh>", '<metadata name="cura:cutting_mesh">True</metadata><mesh>')),
        package(CUBE.replace("<mesh>", '<metadata name="c:infill_mesh">True</metadata><mesh>')),
        package(items=inside("item", '<metadata name="cura:cutting_mesh">True</metadata>')),
        package(items=inside("item", '<x:move by="5 0 0"/>'), attributes=PLACED),
        package(items=inside("item", "<transform>5 0 0</transform>")),
        package(inside("vertex", '<x:delta x="9"/>'), attributes=PLACED),
        package(inside("triangle", "<x:curve/>"), attributes=PLACED),
        package(PARENT.replace("/></c", "><x:place/></component></c"), SECOND, attributes=PLACED),
        package(items=ITEM + f"<metadatagroup>{AWAY}</metadatagroup>"),
        package(f"<x:group>{CUBE}</x:group>", attributes=PLACED),
        package(items=ITEM + '<item xmlns="" objectid="1"/>'),
        package(PARENT.replace("</c", '<component xmlns="" objectid="1"/></c'), SECOND),
        package(items='<item objectid="1" c:transform="1"/>', attributes=f'xmlns:c="{CORE}"'),
        package(CUBE.replace("<object ", '<object s:meshresolution="lowres" '), attributes=PLACED),
        package(CUBE.replace("<object ", '<object x:new="1" '), attributes=PLACED),
        package(items=ITEM + f"<x:g>{AWAY}</x:g>", attributes=f'{PLACED} mc:Ignorable="x"'),
        package(attributes=f'{PLACED} mc:MustUnderstand="x"'),
        package(
            CUBE.replace("<object ", '<object s:slicestackid="9" '),
            attributes=f'{PLACED} mc:Ignorable="s"',
        ),
        package(
            CUBE.replace("<triangle ", '<triangle d:did="9" '),
            attributes=f'{PLACED} mc:Ignorable="d"',
        ),
    ],
)
def test_what_nobody_knows_blocks_a_pass(tmp_path, content):
    assert set(warnings(loaded(tmp_path, "a.3mf", content))) == {"unread"}


@pytest.mark.parametrize(
    "content",
    [
        package(attributes=f'{PLACED} mc:Ignorable="x"'),
        package(
            CUBE.replace("<object ", '<object x:new="1" ').replace("</mesh>", "<x:note/></mesh>"),
            attributes=f'{PLACED} mc:Ignorable="x"',
        ),
        package(CUBE.replace("<object ", '<object s:meshresolution="fullres" '), attributes=PLACED),
        package(CUBE.replace("<object ", '<object colorid="1" materialid="2" ')),
        package(CUBE.replace("<triangle ", '<triangle colorid="1" cv1="0" cv2="1" cv3="2" ')),
        package(CUBE.replace("</vertices>", "</vertices><texturevertices/>")),
        package(items=inside("item", '<metadatagroup><metadata name="a"/></metadatagroup>')),
        package(
            attributes='requiredextensions="k" '
            'xmlns:k="http://schemas.microsoft.com/3dmanufacturing/securecontent/2019/04"'
        ),
    ],
)
def test_what_makes_no_body_is_harmless(tmp_path, content):
    assert warnings(loaded(tmp_path, "a.3mf", content)) == {}


def test_a_coordinate_of_several_lines_is_refused(tmp_path):
    """Its three further numbers would be a vertex, and all later ones another."""
    broken = CUBE.replace('x="1"', 'x="1&#10;2&#10;3&#10;4"', 1)
    assert refusal(tmp_path, "a.3mf", package(broken))[0] == "bad-record"


@pytest.mark.parametrize(
    ("old", "new"), [('x="1"', 'x="1_0"'), ('x="1"', 'x="\u0661"'), ('v1="1"', 'v1="0_1"')]
)
def test_numbers_that_xml_does_not_know_are_refused(tmp_path, old, new):
    code, message = refusal(tmp_path, "a.3mf", package(CUBE.replace(old, new)))
    assert code == "bad-record"
    assert "is not a number" in message or "expected a coordinate" in message


@pytest.mark.parametrize(
    "content",
    [
        package(CUBE.replace("<mesh>", '<metadata name="cura:cuting_mesh">True</metadata><mesh>')),
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


SLIC3R = "Metadata/Slic3r_PE_model.config"
FAR = [(x + 5, y, z) for x, y, z in files.CUBE_POINTS]
TWO = files.object_3mf(
    1, files.CUBE_POINTS + FAR, files.CUBE + [(a + 8, b + 8, c + 8) for a, b, c in files.CUBE]
)


def prusa(kind: str, *, key: str = "volume_type") -> bytes:
    """Two cubes in one object; the second one is a volume of this kind."""
    return with_config(TWO, ITEM, SLIC3R, prusa_config(kind, key))


def prusa_config(kind: str, key: str = "volume_type") -> str:
    return (
        '<config><object id="1"><volume firstid="0" lastid="11"/><volume firstid="12" lastid="23">'
        f'<metadata type="volume" key="{key}" value="{kind}"/></volume></object></config>'
    )


def bambu(kind: str) -> bytes:
    """Two components in one object; the second one is a part of this kind."""
    moved = '<component objectid="2" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>'
    parts = '<component objectid="1"/>' + moved
    resources = CUBE + files.object_3mf(2) + files.components_3mf(3, parts)
    name = "Metadata/model_settings.config"
    return with_config(resources, '<item objectid="3"/>', name, bambu_config(kind))


def bambu_config(kind: str) -> str:
    return (
        '<config><object id="3"><part id="1" subtype="normal_part"/>'
        f'<part id="2" subtype="{kind}"/></object></config>'
    )


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


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("volume_type", "volume_tpye"),
        (" key=", " kye="),
        (" value=", " vlaue="),
        ("<volume ", "<volum "),
        ("<object ", "<objct "),
        ("<metadata ", "<metdata "),
        (" subtype=", " subtpye="),
        (" subtype=", " SubType="),
        ("<part ", "<prat "),
    ],
)
def test_a_misspelt_name_in_a_config_of_a_slicer_is_refused(tmp_path, old, new):
    config = prusa_config("NegativeVolume") if old in prusa_config("") else bambu_config("part")
    config = config.replace(old, new).replace(f"</{old[1:-1]}>", f"</{new[1:-1]}>")
    content = with_config(TWO, ITEM, SLIC3R, config)
    assert refusal(tmp_path, "a.3mf", content)[0] == "misspelt"


@pytest.mark.parametrize(
    "name", ["Metadata/Slic3r_PE_modle.config", "Metadata/modle_settings.config", "_rels/.rel"]
)
def test_a_misspelt_side_file_is_refused(tmp_path, name):
    assert refusal(tmp_path, "a.3mf", more(package(), **{name: ""}))[0] == "misspelt"


def test_side_files_of_slicers_for_printing_are_harmless(tmp_path):
    names = """slice_info.config project_settings.config Slic3r_PE.config process_settings_1.config
        _rels/model_settings.config.rels Slic3r_PE_layer_heights_profile.txt plate_1.gcode.md5
        Prusa_Slicer_custom_gcode_per_print_z.xml cut_information.xml top_1.png thumbnail.jpg"""
    parts = {f"Metadata/{name}": "" for name in names.split()} | {"History/history.xml": ""}
    assert warnings(loaded(tmp_path, "a.3mf", more(package(), **parts))) == {}


@pytest.mark.parametrize(
    "name",
    [
        "Metadata/Slic3r_PE_sla_drain_holes.txt",
        "Metadata/geometry.xml",
        "Metadata/moves.json",
        "3D/more.stl",
    ],
)
def test_a_side_file_that_nobody_knows_blocks_a_pass(tmp_path, name):
    content = more(package(), **{name: "object_id=1|0 0 0"})
    assert set(warnings(loaded(tmp_path, "a.3mf", content))) == {"unread"}


@pytest.mark.parametrize(
    ("parent", "child", "known"),
    [
        ("<object ", "<boolean/>", False),
        ("<config>", "<move/>", False),
        ("<config>", "<plate/>", True),
        ("<part ", "<mesh_stat/>", True),
    ],
)
def test_elements_in_a_config_of_a_slicer(tmp_path, parent, child, known):
    config = bambu_config("normal_part").replace('"/>', '"></part>')
    end = config.index(">", config.index(parent)) + 1
    config = config[:end] + child + config[end:]
    content = with_config(CUBE, ITEM, "Metadata/model_settings.config", config)
    assert set(warnings(loaded(tmp_path, "a.3mf", content))) == (set() if known else {"unread"})


def test_an_object_of_modifiers_alone_is_no_body(tmp_path):
    config = prusa_config("ParameterModifier").replace('"12"', '"0"')
    content = with_config(TWO + files.object_3mf(2), ITEM + SECOND, SLIC3R, config)
    scene = load(tmp_path, "a.3mf", content)
    (body,) = scene.bodies
    assert body.file.mesh.bounds == ((0, 0, 0), (1, 1, 1))
    assert [issue.code for issue in scene.issues] == ["left-out"]


@pytest.mark.parametrize(("old", "new"), [("/core/2015/02", "/core/2031/02"), ("model", "mdoel")])
def test_another_outermost_element_is_refused(tmp_path, old, new):
    model = files.model_3mf(CUBE, ITEM).decode().replace(old, new)
    code, message = refusal(
        tmp_path, "a.3mf", files.package_3mf({"3D/3dmodel.model": model.encode()})
    )
    assert (code, "outermost" in message) == ("unsupported-feature", True)


def test_a_config_whose_outermost_element_is_another_is_refused(tmp_path):
    content = with_config(TWO, ITEM, SLIC3R, f"<x>{prusa_config('NegativeVolume')}</x>")
    assert refusal(tmp_path, "a.3mf", content)[0] == "bad-record"


def test_a_modifier_that_could_be_one_of_two_parts_cannot_be_left_out(tmp_path):
    parts = '<component objectid="2"/>' + AWAY.replace("item", "component").replace("1", "2", 1)
    resources = CUBE + files.object_3mf(2) + files.components_3mf(3, parts)
    name = "Metadata/model_settings.config"
    content = with_config(resources, '<item objectid="3"/>', name, bambu_config("modifier_part"))
    assert refusal(tmp_path, "a.3mf", content)[0] == "unsupported-feature"


def test_an_object_with_two_meshes_is_refused(tmp_path):
    mesh = CUBE[CUBE.index("<mesh>") : CUBE.index("</mesh>") + len("</mesh>")]
    code, message = refusal(tmp_path, "a.3mf", package(CUBE.replace("</mesh>", f"</mesh>{mesh}")))
    assert (code, "two <mesh>" in message) == ("bad-record", True)


@pytest.mark.parametrize("packing", [zipfile.ZIP_DEFLATED, zipfile.ZIP_STORED])
@pytest.mark.parametrize("little", [True, False])
def test_a_part_may_unpack_to_many_times_its_size_if_that_is_little(monkeypatch, packing, little):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", packing) as archive:
        archive.writestr("a", b" " * 100_000)
    monkeypatch.setattr(zip_guard, "ANY_UNPACKED", 100_000 if little else 99_999)
    with zip_guard.opened_zip(content.getvalue(), "a package") as package:
        if little or packing == zipfile.ZIP_STORED:
            assert len(zip_guard.read_part(package, "a", MOST)) == 100_000
            return
        with pytest.raises(Refused, match="limit of 100 times as many") as refused:
            zip_guard.read_part(package, "a", MOST)
        assert refused.value.code == "too-large"
