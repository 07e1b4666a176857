"""`build/links/satcheck/<room>`: the layout of the installed package, over the working tree.

The rooms lie at the top of the repository and become `satcheck.<room>` when the wheel is built;
static tools see neither that mapping nor, when only the installed copy is there, the latest edit.
"""

from __future__ import annotations

import shutil
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LINKS = ROOT / "build" / "links"
PACKAGE = ROOT / "api" / "satcheck"  # its own files, beside the rooms
STUBS = "_native"  # of the compiled module; the build makes them, so they lie where it is installed
ROOMS = ("plugins", "cli", "audit", "verify", "report", "scene", "decompose", "core")


def installed_package() -> Path:
    spec = find_spec("satcheck")
    if spec is None or spec.origin is None:
        raise RuntimeError("satcheck is not installed: make test installs it")
    return Path(spec.origin).parent


def make_links(folder: Path) -> None:
    """Links, or copies where the system refuses links (Windows without developer mode)."""
    package = folder / "satcheck"
    package.mkdir(parents=True, exist_ok=True)
    (package / "_version.py").write_text('__version__ = "0"\n', encoding="utf-8")
    rooms = (ROOT / room for room in ROOMS)
    for source in (*PACKAGE.glob("*.py"), installed_package() / STUBS, *rooms):
        link = package / source.name
        if link.is_symlink() or link.is_file():
            link.unlink()
        elif link.exists():
            shutil.rmtree(link)
        try:
            link.symlink_to(source, target_is_directory=source.is_dir())
        except OSError:
            copy = shutil.copytree if source.is_dir() else shutil.copy
            copy(source, link)
