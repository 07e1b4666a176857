"""For all tests: Ctrl-C means Ctrl-C, and the processes that read files are started once.

A background job of a shell ignores SIGINT, and every child would inherit that; some tests send it.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from functools import cache

import pytest

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True, scope="session")
def one_set_of_reading_children() -> Iterator[None]:
    """A process that reads files imports a large parser: it reads those of all tests. No answer
    depends on the files before (tests/scene/test_reading_children.py)."""
    from satcheck.scene import mesh_files

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mesh_files, "ReadingChildren", cache(mesh_files.ReadingChildren))
        yield
