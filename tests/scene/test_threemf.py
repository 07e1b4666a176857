"""Elements of 3MF models that no specification knows, and those of undeclared prefixes."""

from __future__ import annotations

import pytest

from tests.scene import files
from tests.scene.loading import loaded, refusal, warnings

CUBE = files.object_3mf(1)
ITEM = '<item objectid="1"/>'


def package(resources: str = CUBE, items: str = ITEM, **keys: str) -> bytes:
    return files.package_3mf({"3D/3dmodel.model": files.model_3mf(resources, items, **keys)})


@pytest.mark.parametrize(
    "content",
    [
        package(CUBE + '<my:settings speed="3"><my:nozzle/></my:settings>'),
        package(CUBE.replace("<triangle ", '<triangle my:paint="4" ')),
        package(CUBE.replace("<object ", '<object my:hidden="no" ')),
        package(f'<my:group id="9"><multi pindices="0"/></my:group>{CUBE}'),
        package(f'<my:config xmlns="urn:other"><vertex/></my:config>{CUBE}'),
    ],
)
def test_undeclared_prefixes_outside_of_geometry(tmp_path, content):
    file = loaded(tmp_path, "a.3mf", content)
    assert warnings(file) == {}
    assert file.health.volume == 1.0


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
    assert code == "unsupported-feature"
    assert "my" in message


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
    assert code == "unsupported-feature"
    assert "unknown" in message
