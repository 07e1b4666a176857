"""Opens untrusted zip archives. Damage is an error, and so is a part too large for a file."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager

from satcheck.scene.access import Most
from satcheck.scene.errors import Refused
from satcheck.scene.files.limits import ANY_UNPACKED, MAX_UNPACKED


@contextmanager
def opened_zip(data: bytes | memoryview, kind: str) -> Iterator[zipfile.ZipFile]:
    """kind: such as "a 3MF file", for messages. Raises Refused for any error in the archive,
    also while the `with` block reads its parts."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            yield archive
    except zipfile.BadZipFile as error:
        raise Refused("not-this-format", f"not {kind}: {error}") from None
    except (zlib.error, EOFError, ValueError) as error:  # ValueError: an offset before its start
        raise Refused("bad-record", f"damaged zip data: {error}") from None
    except (RuntimeError, NotImplementedError) as error:  # encrypted, or an unknown compression
        raise Refused("unsupported-feature", f"zip: {error}") from None


def read_part(archive: zipfile.ZipFile, name: str, most: Most) -> bytes:
    """Return the content of a part. Raises Refused if it unpacks to too much."""
    entry = archive.getinfo(name)
    most.refuse_beyond(entry.file_size, f"part {name!r}, unpacked")
    if entry.file_size > max(ANY_UNPACKED, MAX_UNPACKED * entry.compress_size):
        message = (
            f"part {name!r}: {entry.file_size} bytes, packed into {entry.compress_size}, exceed "
            f"the limit of {MAX_UNPACKED} times as many. If you trust the file, pack it with zip -0"
        )
        raise Refused("too-large", message)
    return archive.read(entry)
