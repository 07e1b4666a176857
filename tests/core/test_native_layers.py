"""The folders of core/native are layers: each includes only itself and those before it."""

import re
from pathlib import Path

NATIVE = Path(__file__).parents[2] / "core" / "native"
LISTED = re.search(r"foreach\(layer (.*?)\)", (NATIVE / "CMakeLists.txt").read_text())
assert LISTED is not None
LAYERS = LISTED[1].split()


def included_layers(source: Path) -> set[str]:
    return {path.split("/")[0] for path in re.findall(r'#include "(.+?)"', source.read_text())}


def test_every_folder_is_a_layer() -> None:
    folders = {folder.name for folder in NATIVE.iterdir() if folder.is_dir()}
    assert folders == {*LAYERS, "bindings", "tests"}


def test_includes_point_one_way() -> None:
    sources = [source for layer in LAYERS for source in sorted((NATIVE / layer).glob("*.[ch]pp"))]
    assert len(sources) > 150
    upward = {
        str(source.relative_to(NATIVE)): above
        for source in sources
        if (above := included_layers(source) - set(LAYERS[: LAYERS.index(source.parent.name) + 1]))
    }
    assert upward == {}
