"""A JSON report of a check, or of many assets, as a file."""

from __future__ import annotations

from pathlib import Path

import msgspec

from satcheck.core.errors import SatcheckError
from satcheck.report.assets import AssetsReport
from satcheck.report.report import Report
from satcheck.scene.opening import read_whole

MOST_BYTES = 1 << 30


def read_report(path: Path) -> Report | AssetsReport:
    """Raises SatcheckError: `bad-report`, or a code about the file."""
    try:
        data = read_whole(str(path), path, MOST_BYTES)
        head = msgspec.json.decode(data)
        if isinstance(head, dict) and "assets" in head:
            return msgspec.convert(head, AssetsReport)
        return msgspec.convert(head, Report)
    except (msgspec.MsgspecError, UnicodeError, RecursionError) as error:
        reason = f"no JSON report of this version of satcheck: {error}"
        raise SatcheckError("bad-report", reason, file=str(path)) from None
