"""Small worlds for tests of batches."""

from __future__ import annotations

import random
import shutil
from pathlib import Path

from satcheck.audit.batch.options import World
from tests.cli.process import SAMPLES


def make_worlds(folder: Path, count: int) -> list[World]:
    """Scenes of three boxes at random places, in the folder."""
    places = random.Random(count)
    for name in ("box.obj", "box_pushed.stl"):
        shutil.copy(SAMPLES / name, folder)
    return [_world(folder / f"{number:04}.toml", places) for number in range(count)]


def _world(path: Path, places: random.Random) -> World:
    lines = ['schema = "satcheck.scene/1"']
    for name in ("a", "b", "c"):
        x, y, z = (places.uniform(-3, 3) for _ in range(3))
        mesh = places.choice(("box.obj", "box_pushed.stl"))
        lines.append(f'[[bodies]]\nid = "{name}"\nmesh = "{mesh}"\nposition = [{x}, {y}, {z}]')
    path.write_text("\n".join(lines))
    return (str(path),)
