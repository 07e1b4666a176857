"""3DXML: assemblies of tessellated parts, and what could be geometry and is not read."""

from __future__ import annotations

import io
import zipfile

import pytest

from satcheck.scene import load_scene
from tests.scene import files
from tests.scene.loading import loaded, refusal

XSI = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
IDENTITY = "1 0 0 0 1 0 0 0 1"
TRIANGLES = " ".join(str(i) for face in files.CUBE for i in face)


def reference(id_: int, name: str) -> str:
    return f'<Reference3D xsi:type="Reference3DType" id="{id_}" name="{name}"/>'


def part(id_: int, file: str = "cube.3DRep", form: str = "TESSELLATED") -> str:
    return (
        f'<ReferenceRep xsi:type="ReferenceRepType" id="{id_}" name="shape" format="{form}" '
        f'associatedFile="urn:3DXML:{file}"/>'
    )


def inside(above: int, below: int | str, matrix: str = "", kind: str = "Instance3D") -> str:
    placed = f"<RelativeMatrix>{matrix}</RelativeMatrix>" if matrix else ""
    return (
        f'<{kind} id="{100 * above}" name="i"><IsAggregatedBy>{above}</IsAggregatedBy>'
        f"<IsInstanceOf>{below}</IsInstanceOf>{placed}</{kind}>"
    )


PRODUCT = (
    reference(1, "car")
    + reference(2, "wheel")
    + part(3)
    + inside(2, 3, kind="InstanceRep")
    + inside(1, 2, f"{IDENTITY} 10 0 0")
    + inside(1, "urn:3DXML:Reference:loc:2", "0 1 0 -1 0 0 0 0 1 20 0 0")
)


def polygons(faces: str, beside: str = "", kind: str = "PolygonalRepType") -> str:
    positions = ",".join("{} {} {}.00".format(*point) for point in files.CUBE_POINTS)
    return (
        f'<Rep xsi:type="{kind}">{beside}<Faces>{faces}</Faces><VertexBuffer><Positions>'
        f"{positions}</Positions></VertexBuffer></Rep>"
    )


CUBE = polygons(f'<Face triangles="{TRIANGLES}"/>')


def shape(*reps: str) -> str:
    return (
        f'<XMLRepresentation xmlns="http://www.3ds.com/xsd/3DXML" {XSI}>'
        f'<Root xsi:type="BagRepType">{"".join(reps)}</Root></XMLRepresentation>'
    )


def threedxml(product: str = PRODUCT, *, view: str = "", **parts: str) -> bytes:
    document = (
        f'<Model_3dxml xmlns="http://www.3ds.com/xsd/3DXML" {XSI}><ProductStructure root="1">'
        f"{product}</ProductStructure>{view}</Model_3dxml>"
    )
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("Manifest.xml", "<Manifest><Root>Product.3dxml</Root></Manifest>")
        archive.writestr("Product.3dxml", document)
        for name, content in {"cube": shape(CUBE), **parts}.items():
            archive.writestr(f"{name}.3DRep", content)
    return stream.getvalue()


def test_a_part_is_placed_once_for_each_instance(tmp_path):
    (tmp_path / "a.3dxml").write_bytes(threedxml())
    scene = load_scene([tmp_path / "a.3dxml"])
    assert [body.id for body in scene.bodies] == ["car/wheel/shape", "car/wheel-2/shape"]
    assert scene.bodies[0].world_mesh().bounds == ((10, 0, 0), (11, 1, 1))
    assert scene.bodies[1].world_mesh().bounds == ((19, 0, 0), (20, 1, 1))
    whole = loaded(tmp_path, "b.3dxml", threedxml())
    assert whole.units == "millimeter"
    assert whole.health.volume == 2.0


def test_two_parts_of_one_name_stay_two(tmp_path):
    product = PRODUCT + part(4, "small.3DRep") + inside(2, 4, kind="InstanceRep")
    upper = shape(CUBE.replace("0.00", "2.00").replace("1.00", "3.00"))
    file = loaded(tmp_path, "a.3dxml", threedxml(product, small=upper))
    assert file.mesh.bounds == ((10, 0, 0), (20, 1, 3))
    assert file.health.volume == 4.0


def test_strips_fans_and_several_faces(tmp_path):
    quads = [" ".join(map(str, (a, b, d, c))) for a, b, c, d in files.CUBE_QUADS[:3]]
    fans = [" ".join(map(str, face)) for face in files.CUBE_QUADS[3:]]
    faces = f'<Face strips="{",".join(quads)}"/><Face fans="{",".join(fans)}"/>'
    file = loaded(tmp_path, "a.3dxml", threedxml(cube=shape(polygons(faces))))
    assert file.mesh.triangle_count == 24
    assert file.health.closed
    assert file.health.volume == 2.0


def test_coarser_levels_of_detail_are_not_added(tmp_path):
    lod = '<PolygonalLOD accuracy="1"><Faces><Face triangles="0 1 2"/></Faces></PolygonalLOD>'
    cube = shape(polygons(f'<Face triangles="{TRIANGLES}"/>', lod + "<Edges/>"))
    assert loaded(tmp_path, "a.3dxml", threedxml(cube=cube)).mesh.triangle_count == 24


def moved_view(id_: int) -> str:
    return (
        "<DefaultView><DefaultViewProperty><OccurenceId><id>urn:3DXML:Product.3dxml#"
        f"{id_}</id></OccurenceId><RelativePosition>1 0 0 0 0 1 0 -1 0 0 0 0</RelativePosition>"
        "</DefaultViewProperty></DefaultView>"
    )


def test_a_view_of_the_whole_product_is_not_applied(tmp_path):
    file = loaded(tmp_path, "a.3dxml", threedxml(view=moved_view(1)))
    assert file.mesh.bounds == ((10, 0, 0), (20, 1, 1))


@pytest.mark.parametrize(
    ("content", "code", "said"),
    [
        (threedxml(view=moved_view(2)), "unsupported-feature", "a view that moves a part"),
        (threedxml(PRODUCT.replace("TESS", "UVR")), "unsupported-feature", "format 'UVRELLATED'"),
        (threedxml(PRODUCT.replace("cube.", "gone.")), "missing-resource", "gone.3DRep"),
        (threedxml(PRODUCT + inside(2, 9)), "index-out-of-range", "'9'"),
        (threedxml(PRODUCT + inside(2, 1)), "reference-cycle", "contains itself"),
        (threedxml(reference(1, "car")), "empty-mesh", "no part"),
        (threedxml(PRODUCT.replace(" 10 0 0", " 10 0")), "bad-record", "11 numbers, not 12"),
        (threedxml(cube=shape()), "empty-mesh", "no triangles"),
        (threedxml(cube=shape(polygons("<Face/>"))), "unsupported-feature", "without triangles"),
        (
            threedxml(cube=shape(polygons('<Face triangles="0 1 8"/>'))),
            "index-out-of-range",
            "vertex 8 of 8",
        ),
        (
            threedxml(cube=shape(polygons("", kind="NurbsRepType"))),
            "unsupported-feature",
            "type 'NurbsRepType'",
        ),
        (
            threedxml(cube=shape(CUBE.replace("<Faces>", "<Trim/><Faces>"))),
            "unsupported-feature",
            "<Trim>: could be geometry",
        ),
        (threedxml(cube=shape(CUBE.replace(".00", "nan"))), "bad-record", "could not convert"),
        (threedxml(cube=" " * (32 << 20)), "too-large", "unpacks"),
        (files.obj(), "not-this-format", "not a 3DXML file"),
    ],
)
def test_what_is_refused(tmp_path, content, code, said):
    found, message = refusal(tmp_path, "a.3dxml", content)
    assert found == code
    assert said in message
