"""The file of a baseline."""

from __future__ import annotations

import os
from pathlib import Path

import msgspec

from satcheck.core.errors import SatcheckError
from satcheck.report.baseline import Baseline


def read_baseline(path: Path) -> Baseline:
    """Raises SatcheckError: `unreadable-file`, `bad-baseline`."""
    try:
        return msgspec.json.decode(path.read_bytes(), type=Baseline)
    except OSError as error:
        reason = f"cannot be read: {error.strerror}"
        raise SatcheckError("unreadable-file", reason, file=str(path)) from None
    except msgspec.DecodeError as error:
        raise SatcheckError("bad-baseline", f"no baseline: {error}", file=str(path)) from None


def asset_key(asset: str, baseline: Path) -> str:
    """The name of an asset in a baseline: relative to the folder of the baseline, with `/`, so that
    it does not depend on where the command runs."""
    return Path(os.path.relpath(asset, baseline.parent)).as_posix()
