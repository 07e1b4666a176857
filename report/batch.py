"""A line of the results of a batch: `satcheck.result/1`, one world and its report."""

from __future__ import annotations

from typing import Literal

from satcheck.report.assets import AssetVerdict
from satcheck.report.report import Report
from satcheck.report.values import Sha256, Value

SCHEMA: Literal["satcheck.result/1"] = "satcheck.result/1"


class InputFile(Value, frozen=True):
    """A file that the check has read or looked for. sha256: of its bytes; for a
    folder or a file that cannot be read, of words that say so. None: it was not there. A path that
    ends in `/` stands for the names of the folders in this folder."""

    path: str
    sha256: Sha256 | None


class Result(Value, frozen=True, kw_only=True):
    """files: of the world, as given; the first one names it. inputs: every file that the answer
    depends on. key: of the contents of these, the options and the version of satcheck: the same key
    means the same answer. None: the next run checks this world again, because a process of its
    check was lost, or a file changed meanwhile."""

    schema: Literal["satcheck.result/1"] = SCHEMA
    files: tuple[str, ...]
    key: Sha256 | None
    verdict: AssetVerdict
    inputs: tuple[InputFile, ...]
    report: Report
