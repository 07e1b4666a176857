"""A browser for the tests of the page: Chromium without a window, with WebGL in software."""

from __future__ import annotations

import os
import shutil
from importlib.util import find_spec

ARGUMENTS = ["--headless=new", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
if hasattr(os, "geteuid") and os.geteuid() == 0:
    ARGUMENTS.append("--no-sandbox")  # Chromium has none for root
_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def missing() -> str | None:
    """What the tests lack here."""
    if find_spec("playwright") is None:
        return "playwright is missing: pip install '.[browser]'"
    return None if program() else f"there is no {_NAMES[0]} on the path"


def program() -> str | None:
    return next(filter(None, map(shutil.which, _NAMES)), None)
