"""The zip archive of a BCF file, the same bytes for the same files."""

from __future__ import annotations

import io
import os
import time
import zipfile
from collections.abc import Mapping
from datetime import UTC, datetime

_EARLIEST = (1980, 1, 1, 0, 0, 0)  # of zip; the date of every entry


def archive(files: Mapping[str, bytes]) -> bytes:
    """files: name -> content, in this order."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as packed:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, date_time=_EARLIEST)
            entry.compress_type = zipfile.ZIP_DEFLATED
            packed.writestr(entry, data)
    return content.getvalue()


def date() -> str:
    """Return the date of topics: now, or SOURCE_DATE_EPOCH (https://reproducible-builds.org), in
    UTC."""
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
