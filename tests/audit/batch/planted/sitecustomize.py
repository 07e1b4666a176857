"""Makes some files and pairs end their process, as native code does. On PYTHONPATH, each process of
satcheck imports this at its start.

A mesh file is read as usual unless its name holds a word of `_ENDS`; so is a pair checked, unless
the id of its first body does. A file that a child of the process reads is named by its folder.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import time
from collections.abc import Callable
from importlib.abc import MetaPathFinder
from importlib.util import find_spec
from pathlib import Path
from typing import Any


def _hang() -> None:
    """As native code that never gives Python a turn."""
    _begun()
    ctypes.PyDLL(None).pause()


def _deaf() -> None:
    """As native code that gives other threads their turn, and hears no signal."""
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    _begun()
    while True:
        ctypes.CDLL(None).pause()


def _begun() -> None:
    if told := os.environ.get("PLANTED_BEGUN"):
        Path(told).touch()


def _segfault() -> None:
    os.kill(os.getpid(), signal.SIGSEGV)


_ENDS: dict[str, Callable[[], object]] = {
    "segfault": _segfault,
    "abort": os.abort,
    "hang": _hang,
    "deaf": _deaf,
    "nap": lambda: time.sleep(0.6),
    "bomb": lambda: bytearray(1 << 50),
}


def _planted(function: Callable[..., Any], name_of: Callable[[Any], str]) -> Callable[..., Any]:
    def instead(first: Any, *others: Any, **options: Any) -> Any:
        for word, end in _ENDS.items():
            if word in name_of(first):
                end()
        return function(first, *others, **options)

    return instead


def _split(_: bytes) -> str:
    """Counts the meshes that CoACD splits."""
    if folder := os.environ.get("PLANTED_SPLITS"):
        (Path(folder) / str(os.getpid())).touch()
    return ""


# The module, what in it, and how its first argument is named.
_PLANTS: dict[str, tuple[str, Callable[[Any], str]]] = {
    "satcheck.scene.mesh_files": ("open_file", os.path.basename),
    "satcheck.scene.files.reading_children": (
        "_content",
        lambda file: Path(file.directory).name,
    ),
    "satcheck.decompose.coacd_server": ("serve", _split),
    "satcheck.audit.checked_pairs": ("examine", lambda draft: draft.pair.a.id),
}


class _Planter(MetaPathFinder):
    def __init__(self) -> None:
        self._looking = False

    def find_spec(self, name: str, *_: object) -> Any:
        if name not in _PLANTS or self._looking:
            return None
        self._looking = True
        spec = find_spec(name)
        self._looking = False
        assert spec is not None
        assert spec.loader is not None
        execute = spec.loader.exec_module
        what, name_of = _PLANTS[name]

        def planted(module: Any) -> None:
            execute(module)
            setattr(module, what, _planted(getattr(module, what), name_of))

        spec.loader.exec_module = planted  # type: ignore[method-assign]
        return spec


sys.meta_path.insert(0, _Planter())
