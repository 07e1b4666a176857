"""ZAE: a zip archive of a COLLADA document and its textures.

Khronos, "COLLADA 1.5.0 specification" (2008), chapter 2: manifest.xml names the document in
<dae_root>. Many archives have no manifest. Then the archive has to hold exactly one document, which
is read.
"""

from __future__ import annotations

import posixpath
import zipfile
from urllib.parse import unquote

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.collada import read_collada
from satcheck.scene.loading.raw_mesh import RawMesh
from satcheck.scene.loading.xml_tree import read_elements
from satcheck.scene.loading.zip_guard import open_part, opened_zip

_MANIFEST = "manifest.xml"


def read_zae(data: memoryview) -> RawMesh:
    """Raises MeshFileError without a file name."""
    with opened_zip(data, "a ZAE file") as archive:
        document = open_part(archive, _name_of_document(archive)).read()
    return read_collada(document)


def _name_of_document(archive: zipfile.ZipFile) -> str:
    names = archive.namelist()
    if _MANIFEST in names:
        wanted = posixpath.normpath(unquote(_root_in_manifest(archive)).partition("#")[0])
        if wanted not in names:
            message = f"the manifest names {wanted!r}, which is not in the archive"
            raise MeshFileError("missing-resource", message)
        return wanted
    documents = [name for name in names if name.lower().endswith(".dae")]
    if len(documents) != 1:
        message = f"{len(documents)} COLLADA documents and no {_MANIFEST} to say which counts"
        raise MeshFileError("missing-resource" if not documents else "bad-record", message)
    return documents[0]


def _root_in_manifest(archive: zipfile.ZipFile) -> str:
    with open_part(archive, _MANIFEST) as stream:
        root = read_elements(stream)
    roots = (element for element in (root, *root.below()) if element.tag == "dae_root")
    return "".join(element.text for element in roots)
