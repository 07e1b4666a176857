"""The reading child: checks a file, reads it, checks what came out."""

from __future__ import annotations

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import protocol
from satcheck.scene.loading.raw_mesh import RawScene, alone


def serve(request: bytes) -> bytes:
    """Answers one request of `protocol`; a file that cannot be used is an answer too."""
    try:
        return protocol.pack_reply(_answer(protocol.unpack_request(request)))
    except MeshFileError as error:
        return protocol.pack_reply(error)


def _answer(request: protocol.Request) -> RawScene:
    scene = _read(request)
    if not request.flat:
        return scene
    from satcheck.scene.loading.flatten import flattened

    return alone(flattened(scene))


def _read(request: protocol.Request) -> RawScene:
    if request.format == "3mf":
        from satcheck.scene.loading.threemf import read_3mf

        return read_3mf(request.data)
    if request.format == "dae":
        from satcheck.scene.loading.collada import read_collada

        return alone(read_collada(bytes(request.data)))
    if request.format == "3dxml":
        from satcheck.scene.loading.threedxml import read_3dxml

        return read_3dxml(request.data)
    if request.format == "xaml":
        from satcheck.scene.loading.xaml import read_xaml

        return alone(read_xaml(request.data))
    if request.format == "zae":
        from satcheck.scene.loading.zae import read_zae

        return alone(read_zae(request.data))
    from satcheck.scene.loading.gltf import read_gltf

    return read_gltf(
        request.data,
        request.directory,
        binary=request.format == "glb",
        allow_outside=request.allow_outside,
        isolated=True,
    )
