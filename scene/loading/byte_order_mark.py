"""Text that begins with a byte order mark, as UTF-8 without one."""

from __future__ import annotations

import codecs

from satcheck.scene.errors import MeshFileError

# The longer marks first: the mark of UTF-32 begins like that of UTF-16.
_WIDE = (
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)


def without_byte_order_mark(data: bytes) -> bytes:
    """Raises MeshFileError, without a file name, for text that its mark does not fit."""
    if data.startswith(codecs.BOM_UTF8):
        return data[len(codecs.BOM_UTF8) :]
    for mark, encoding in _WIDE:
        if data.startswith(mark):
            try:
                return data[len(mark) :].decode(encoding).encode()
            except UnicodeError:
                name = encoding[: len("utf-16")].upper()
                raise MeshFileError(
                    "bad-encoding", f"the byte order mark is that of {name}, the text is not"
                ) from None
    return data
