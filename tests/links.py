"""`build/links/satcheck/<room>`: the layout of the installed package, over the working tree.

The rooms lie at the top of the repository and become `satcheck.<room>` when the wheel is built;
static tools see neither that mapping nor, when only the installed copy is there, the latest edit.
"""

from __future__ import annotations

import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LINKS = ROOT / "build" / "links"
PACKAGE = ROOT / "api" / "satcheck"  # its own files, beside the rooms
ROOMS = ("plugins", "cli", "audit", "verify", "report", "scene", "decompose", "core")


def make_links(folder: Path) -> None:
    """Links, or copies where the system refuses links (Windows without developer mode)."""
    package = folder / "satcheck"
    package.mkdir(parents=True, exist_ok=True)
    (package / "_version.py").write_text('__version__ = "0"\n', encoding="utf-8")
    for source in (*PACKAGE.glob("*.py"), PACKAGE / "_native", *(ROOT / room for room in ROOMS)):
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
