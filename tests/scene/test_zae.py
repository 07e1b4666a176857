"""ZAE: which document of the archive counts, and archives that are wrong."""

from __future__ import annotations

import io
import zipfile

import pytest

from tests.scene import files
from tests.scene.loading import loaded, refusal

MANIFEST = '<?xml version="1.0"?><dae_root>./models/the%20cube.dae</dae_root>'
OTHER = files.collada(points=files.TETRAHEDRON_POINTS, faces=files.TETRAHEDRON)


def archive(**parts: str | bytes) -> bytes:
    """Parts by their names, with "__" for "/" and "_" for "."."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as package:
        for name, content in parts.items():
            package.writestr(name.replace("__", "/").replace("_", "."), content)
    return stream.getvalue()


def test_the_only_document(tmp_path):
    file = loaded(tmp_path, "a.zae", archive(cube_dae=files.collada(), image_png=b"\x89PNG"))
    assert file.format == "zae"
    assert file.health.volume == 1.0


def test_the_document_that_the_manifest_names(tmp_path):
    parts = {"a_dae": OTHER, "models__the cube_dae": files.collada(), "manifest_xml": MANIFEST}
    assert loaded(tmp_path, "a.zae", archive(**parts)).health.volume == 1.0


@pytest.mark.parametrize(
    ("content", "code", "said"),
    [
        (archive(a_dae=OTHER, b_dae=OTHER), "bad-record", "2 COLLADA documents"),
        (archive(a_txt=""), "missing-resource", "0 COLLADA documents"),
        (archive(a_dae=OTHER, manifest_xml=MANIFEST), "missing-resource", "models/the cube.dae"),
        (archive(a_dae=files.collada()[:-9]), "bad-record", "not well-formed"),
        (archive(a_dae=OTHER)[:-30], "not-this-format", "not a ZAE file"),
        (archive(a_dae=b" " * (32 << 20)), "too-large", "unpacks"),
        (files.collada(), "not-this-format", "not a ZAE file"),
    ],
)
def test_wrong_archives(tmp_path, content, code, said):
    found, message = refusal(tmp_path, "a.zae", content)
    assert found == code
    assert said in message


def test_an_archive_is_no_dae(tmp_path):
    code, message = refusal(tmp_path, "a.dae", archive(a_dae=files.collada()))
    assert code == "format-mismatch"
    assert "a zip archive" in message
