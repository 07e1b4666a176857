"""A small repository of assets, as a game or a robot cell has one.

`python -m tests.asset_repository FOLDER` makes it, with two commits.

`crate.glb` has an overlap that is known: its lid sinks into its body. `shelf.scene.toml` and the
single mesh `bolt.obj` are sound.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import trimesh

SUNK, ON_TOP = 0.9, 1.1
CONFIG = "depth = true\n"
SHELF = """\
schema = "satcheck.scene/1"
units = "mm"

[[bodies]]
id = "board"
shape = {{type = "box", size = [800, 300, 20]}}

[[bodies]]
id = "box"
shape = {{type = "box", size = [200, 200, 200]}}
position = [0, 0, {height}]
"""


def make(folder: Path) -> Path:
    """The repository, whose working tree is clean."""
    assets = folder / "assets"
    assets.mkdir(parents=True)
    git(folder, "init", "--quiet", "--initial-branch", "main")
    write_crate(assets, SUNK)
    write_shelf(assets, 110)
    trimesh.creation.cylinder(radius=4, height=30, sections=12).export(assets / "bolt.obj")
    commit(folder, "Add the assets")
    (folder / "satcheck.toml").write_text(CONFIG)
    commit(folder, "Check them")
    return folder


def write_crate(assets: Path, height: float) -> None:
    """height: of the middle of the lid, whose lower side is 0.1 below it. The body ends at 1."""
    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box((2, 2, 2)), node_name="body", geom_name="body")
    lid = trimesh.creation.box((2.2, 2.2, 0.2))
    placed = np.eye(4)
    placed[2, 3] = height
    scene.add_geometry(lid, node_name="lid", geom_name="lid", transform=placed)
    scene.export(assets / "crate.glb")


def write_shelf(assets: Path, height: float) -> None:
    """height: of the middle of the box, which stands on the board at 110."""
    (assets / "shelf.scene.toml").write_text(SHELF.format(height=height))


def commit(folder: Path, message: str) -> None:
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--message", message)


def git(folder: Path, *words: str) -> None:
    author = ("-c", "user.name=Asset Author", "-c", "user.email=author@example.org")
    subprocess.run(["git", *author, *words], cwd=folder, check=True)


if __name__ == "__main__":
    make(Path(sys.argv[1]))
