"""Writes moved bodies back into the format that they were read from: scene files, USD, glTF."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from satcheck.scene.bodies import Scene
from satcheck.scene.errors import MeshFileError

if TYPE_CHECKING:
    from satcheck.scene.loading.reading_children import ReadingChildren

Vector = tuple[float, float, float]

_SCENES = frozenset((".json", ".toml"))
_USD = frozenset((".usd", ".usda", ".usdc"))
_GLTF = frozenset((".glb", ".gltf"))
# Endings of a file -> those under which it is written back.
WRITTEN_BACK = {
    **{ending: frozenset((ending,)) for ending in _SCENES | _GLTF},
    **dict.fromkeys(_USD, _USD),
}


def written_back(
    output: Path,
    source: str,
    scene: Scene,
    translations: Mapping[str, Vector],
    children: ReadingChildren,
    *,
    seconds: float,
) -> str | bytes:
    """The content of `source` with these bodies moved, for the file `output`.

    scene: of the source alone. translations: id -> translation in the world. children, seconds: for
    formats that are written in a child process. Raises SatcheckError: `not-movable`, or the code of
    a broken file.
    """
    ending = Path(source).suffix.lower()
    if ending in _SCENES:
        from satcheck.scene.moved.scene_file import moved_scene_file

        return moved_scene_file(source, output, translations)
    if ending in _GLTF:
        from satcheck.scene.moved.gltf import moved_gltf

        data = _content(source)
        return moved_gltf(data, translations, binary=ending == ".glb")
    from satcheck.scene.moved.usd import Request, moved_usd

    request = Request(
        location=source,
        suffix=output.suffix.lower(),
        bodies=tuple(body.id for body in scene.in_order()),
        translations=dict(translations),
        options=scene.reading,
    )
    return moved_usd(request, children, seconds=seconds)


def _content(source: str) -> bytes:
    try:
        return Path(source).read_bytes()
    except OSError as error:
        reason = f"cannot be read: {error.strerror}"
        raise MeshFileError("unreadable-file", reason, file=source) from None
