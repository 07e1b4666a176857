"""Calls that need no parser: paths, flags, and few options with a value, each a word of its own.

Importing click is a third of the start of a small check. What is spelled otherwise, is wrong, or
asks for help is left to it; what is read here, click reads as the same (tests hold them together).
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from satcheck.cli.choices import ACCURACY, DEPTH_BUDGET, DEPTH_WIDTH, LEAST_SEVERITY
from satcheck.cli.commands import COMMANDS
from satcheck.cli.output import form_of

if TYPE_CHECKING:
    from satcheck.cli.checking import Choices

FLAGS: dict[str, tuple[str, bool]] = {
    "--explain": ("explain", True),
    "--depth": ("depth", True),
    "--no-depth": ("depth", False),
    "--contacts": ("contacts", True),
    "--volume": ("volume", True),
    "--allow-open": ("allow_open", True),
    "--no-cache": ("cache", False),
    "--no-timings": ("timings", False),
    "--exit-zero": ("exit_zero", True),
    "--debug": ("debug", True),
}
VALUES = {"--format": "form", "-o": "output", "--output": "output", "-j": "jobs", "--jobs": "jobs"}
# The formats that --format names, in their order; click shows them in the help.
FORMATS = ("table", "json")
_DEFAULTS: dict[str, Any] = {
    "form": None,
    "output": None,
    "explain": False,
    "depth": None,
    "contacts": False,
    "volume": False,
    "clearance": None,
    "tolerance": None,
    "accuracy": ACCURACY,
    "depth_width": DEPTH_WIDTH,
    "depth_budget": DEPTH_BUDGET,
    "split": None,
    "units": None,
    "fail_on": LEAST_SEVERITY,
    "allow_open": False,
    "cross_check": False,
    "planar": None,
    "certificate": False,
    "jobs": 0,
    "cache": True,
    "timings": True,
    "exit_zero": False,
    "debug": False,
    "allow_outside": False,
}


def plain_choices(arguments: list[str]) -> Choices | None:
    """What the words of a call of `satcheck A B` ask for; None where click has to read them."""
    # Only click expands patterns, which a shell of Windows does not.
    if not arguments or arguments[0] in COMMANDS or sys.platform == "win32":
        return None
    paths: list[str] = []
    options = dict(_DEFAULTS)
    words = iter(arguments)
    for word in words:
        if word in FLAGS:
            name, value = FLAGS[word]
            options[name] = value
        elif word in VALUES:
            read = _value(VALUES[word], next(words, ""))
            if read is None:
                return None
            options[VALUES[word]] = read
        elif not word or word.startswith("-"):
            return None
        else:
            paths.append(word)
    if not paths:
        return None
    from satcheck.cli.checking import Choices
    from satcheck.cli.posing import Posing

    options["form"] = form_of(options["form"], options["output"])
    return Choices(paths=tuple(paths), packages={}, posing=Posing(), **options)


def _value(name: str, text: str) -> str | int | Path | None:
    """None for one that click may refuse."""
    if name == "form":
        return text if text in FORMATS else None
    if name == "jobs":
        return int(text) if text.isascii() and text.isdecimal() and len(text) < 5 else None
    if not text or text.startswith("-") or not _may_be_written(Path(text)):
        return None
    return Path(text)


def _may_be_written(path: Path) -> bool:
    return not os.path.lexists(path) or (path.is_file() and os.access(path, os.R_OK))
