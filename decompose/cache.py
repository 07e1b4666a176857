"""A cache of convex parts on disk. The key of an entry is the content it was computed from.

An entry is one file, `<key>.parts`: magic, the key, the SHA-256 of the payload, the payload. A
complete file is renamed to this name, so a reader sees all of it or nothing. A damaged entry counts
as missing, and the next writer replaces it. A whole one need not be right, as anybody may have
written it: `computation.held_against` looks. If two processes need the same entry, it is computed
once: the second process waits for the file lock of the first.

To clear the cache, delete the folder. If the cache cannot be read or written, the parts are
computed without it, and a note of the result says so.
"""

from __future__ import annotations

import hashlib
import os
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

DIRECTORY_VARIABLE: Final = "SATCHECK_CACHE_DIR"
SWITCH_VARIABLE: Final = "SATCHECK_CACHE"
_SUBDIRECTORY: Final = "decompositions"  # other files in the user's directory are never touched
_ENTRY_SUFFIX: Final = ".parts"
_LOCK_SUFFIX: Final = ".lock"
_TEMPORARY_SUFFIX: Final = ".tmp"
_HEADER: Final = struct.Struct("<8s32s32s")  # magic, key, SHA-256 of the payload
_MAGIC: Final = b"SATPARTS"


class Cache:
    """A directory of entries. It is created when the first entry is stored."""

    def __init__(self, directory: Path | None = None) -> None:
        """directory: None: $SATCHECK_CACHE_DIR, or else the user's cache directory."""
        self.path = (default_directory() if directory is None else directory) / _SUBDIRECTORY

    def load(self, key: bytes) -> bytes | None:
        """The payload of a key of 32 bytes; None: missing or damaged."""
        try:
            data = self._entry(key).read_bytes()
        except OSError:
            return None
        if len(data) < _HEADER.size:
            return None
        magic, stored_key, checksum = _HEADER.unpack_from(data)
        payload = data[_HEADER.size :]
        if magic != _MAGIC or stored_key != key or hashlib.sha256(payload).digest() != checksum:
            return None
        return payload

    def store(self, key: bytes, payload: bytes) -> None:
        """Stores a payload and replaces an old one. Raises OSError on failure."""
        import tempfile

        self.path.mkdir(parents=True, exist_ok=True)
        header = _HEADER.pack(_MAGIC, key, hashlib.sha256(payload).digest())
        descriptor, name = tempfile.mkstemp(suffix=_TEMPORARY_SUFFIX, dir=self.path)
        temporary = Path(name)
        try:
            with os.fdopen(descriptor, "wb") as file:
                file.write(header)
                file.write(payload)
                file.flush()
                os.fsync(file.fileno())
            temporary.replace(self._entry(key))
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise

    @contextmanager
    def single_flight(self, key: bytes, seconds: float) -> Iterator[None]:
        """Holds the lock of one key, so that one process at a time computes its payload.

        Raises OSError if locks are not supported, TimeoutError after `seconds` of waiting.
        """
        from filelock import FileLock, Timeout

        self.path.mkdir(parents=True, exist_ok=True)
        lock = FileLock(self.path / (key.hex() + _LOCK_SUFFIX), timeout=seconds)
        try:
            lock.acquire()
        except Timeout as error:
            raise TimeoutError(f"{lock.lock_file} was held for more than {seconds:g} s") from error
        except NotImplementedError as error:  # file systems without locks
            raise OSError(str(error)) from error
        try:
            yield
        finally:
            lock.release()

    def _entry(self, key: bytes) -> Path:
        return self.path / (key.hex() + _ENTRY_SUFFIX)


def user_cache() -> Cache | None:
    """The cache of the user; None: SATCHECK_CACHE is `off`."""
    return None if os.environ.get(SWITCH_VARIABLE, "").lower() == "off" else Cache()


def default_directory() -> Path:
    chosen = os.environ.get(DIRECTORY_VARIABLE)
    if chosen:
        return Path(chosen)
    import platformdirs

    return platformdirs.user_cache_path("satcheck", appauthor=False)
