"""For all tests: Ctrl-C means Ctrl-C, the processes that read files are started once, and a report
that calls a fit a collision fails the test that made it.

A background job of a shell ignores SIGINT, and every child would inherit that; some tests send it.
"""

from __future__ import annotations

import json
import signal
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from typing import Any

import pytest

from tests.oracles.fits_touch import assert_fits_touch

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True, scope="session")
def one_set_of_reading_children() -> Iterator[None]:
    """A process that reads files imports a large parser: it reads those of all tests, though the
    loading of each scene closes its children. No answer depends on the files before
    (tests/scene/test_reading_children.py)."""
    from satcheck.scene import mesh_files

    class Kept(mesh_files.ReadingChildren):
        def close(self) -> None:
            pass

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mesh_files, "ReadingChildren", cache(Kept))
        yield


@pytest.fixture(autouse=True, scope="session")
def no_fit_is_a_collision() -> Iterator[None]:
    """In every report that a test makes in this process; tests/cli/process.py looks at the rest."""
    from satcheck.report.json import document

    module: Any = import_module("satcheck.audit.check")
    made = module.Report

    def judged(**values: Any) -> Any:
        report = made(**values)
        assert_fits_touch(json.loads(document(report)))
        return report

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "Report", judged)
        yield
