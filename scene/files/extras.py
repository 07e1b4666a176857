"""Imports the libraries of optional formats. A library that is missing is an error that says what
to install."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from satcheck.scene.errors import Refused


def imported(module: str, extra: str, kind: str) -> Any:
    """The module. extra: of satcheck, which installs it. kind: of file, such as "IFC files"."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or not module.startswith(error.name):
            raise
        library = module.partition(".")[0]
        message = f"{kind} need {library}: pip install 'satcheck[{extra}]'"
        raise Refused("missing-extra", message) from None
