"""A JSON report of a check, or of many assets, as a file."""

from __future__ import annotations

from pathlib import Path

import msgspec

from satcheck.core.errors import SatcheckError
from satcheck.report.assets import AssetsReport
from satcheck.report.report import Report


def read_report(path: Path) -> Report | AssetsReport:
    """Raises SatcheckError: `unreadable-file`, `bad-report`."""
    try:
        data = path.read_bytes()
        head = msgspec.json.decode(data)
        if isinstance(head, dict) and "assets" in head:
            return msgspec.convert(head, AssetsReport)
        return msgspec.convert(head, Report)
    except OSError as error:
        reason = f"cannot be read: {error.strerror}"
        raise SatcheckError("unreadable-file", reason, file=str(path)) from None
    except msgspec.MsgspecError as error:
        reason = f"no JSON report of this version of satcheck: {error}"
        raise SatcheckError("bad-report", reason, file=str(path)) from None
