"""Opens the files of inputs: regular files only, no larger than a limit, each noted for whoever
keeps results. Of a mesh file it reads the bytes once, hashes them, and checks suffix and content.
"""

from __future__ import annotations

import codecs
import hashlib
import os
import stat
from io import BufferedReader, FileIO

from satcheck._native.readers import read_file
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import (
    KINDS,
    File,
    Reader,
    ReadLimits,
    mesh_reader,
    reader_of,
    readers,
    values_of,
)
from satcheck.scene.files_read import note
from satcheck.scene.paths import StrPath, suffix_of
from satcheck.scene.plugins import failures

STANDARD_INPUT = "-"
_ENDS = (b"\n", b"\r", b"}", b">")  # of a line, JSON, XML

# Opening one of these may block, or reading it may never end.
_SPECIAL = (
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)
# Relatives of the formats that are read, and what to do with them.
_CONVERTIBLE = {
    ".stpz": "it is a packed STEP file: unpack it and name the .stp file",
    ".stpx": "it is STEP in XML: export a .stp file",
    ".stpxz": "it is packed STEP in XML: export a .stp file",
}
# The longer marks first: the mark of UTF-32 begins like that of UTF-16.
_WIDE_MARKS = (
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)

LARGE_FILE_BYTES = 1_000_000  # larger files get their own thread and are read in pieces
_STL_HEADER_BYTES = 84
_STL_FACET_BYTES = 50
_STL_COUNT = slice(80, 84)

# The first bytes of files that are often misnamed as meshes, and what they are. The marks of a
# reader say which of them its files may have.
_SIGNATURES = (
    (b"\x89PNG\r\n", "a PNG image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"GIF8", "a GIF image"),
    (b"%PDF", "a PDF document"),
    (b"\x1f\x8b", "gzip data"),
    (b"\x7fELF", "an ELF program"),
    (b"version https://git-lfs", "a Git LFS pointer: git lfs pull fetches the file"),
    (b"glTF", "a GLB file"),
    (b"ISO-10303-21;", "a STEP file"),
    (b"PK\x03\x04", "a zip archive"),
    (b"ply\n", "a PLY file"),
    (b"ply\r\n", "a PLY file"),
)

# The words at the start of lines in a text format, without comments.
_FIRST_WORDS = (
    ((b"v", b"vn", b"vt", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl"), "an OBJ file"),
    ((b"OFF", b"COFF", b"NOFF", b"CNOFF", b"STOFF"), "an OFF file"),
    ((b"ply",), "a PLY file"),
    ((b"<?xml", b"<COLLADA"), "an XML file"),
    ((b"{",), "a JSON file"),
)
_TEXT_HEAD_BYTES = 4096
_BINARY_PLY = b"\nformat binary"


def size_of(location: StrPath) -> int:
    """Size of a regular file in bytes. Raises Refused, without a file name, for anything else."""
    location = os.fspath(location)
    if location == STANDARD_INPUT:
        raise Refused("not-a-file", "standard input is not read: give the path of a file")
    note(location)
    try:
        status = os.stat(location)  # noqa: PTH116
    except (FileNotFoundError, NotADirectoryError):
        raise Refused("file-not-found", "no such file") from None
    except OSError as error:
        raise _unreadable(error) from None
    except ValueError as error:  # a path with a NUL character
        raise Refused("unreadable-file", f"cannot be read: {error}") from None
    if stat.S_ISDIR(status.st_mode):
        raise Refused("not-a-file", "is a directory, not a file")
    if not stat.S_ISREG(status.st_mode):
        kind = next((name for test, name in _SPECIAL if test(status.st_mode)), "a special file")
        raise Refused("not-a-file", f"is {kind}, not a file: not read")
    return status.st_size


def read_whole(path: str, location: StrPath, most: int) -> bytes:
    """The bytes of a text file, without padding. Raises Refused, with the path, if it is not a
    regular file, has more than `most` bytes, or cannot be read."""
    try:
        if size_of(location) > most:
            raise _too_large(most)
        with FileIO(location) as raw, BufferedReader(raw) as file:
            data = file.read(most + 1)  # a system file states no size
        if len(data) > most:
            raise _too_large(most)
        return without_padding(data)
    except Refused as error:
        raise Refused(error.code, error.message, file=path) from None
    except OSError as error:
        raise Refused("unreadable-file", f"cannot be read: {error.strerror}", file=path) from None


def without_padding(data: bytes) -> bytes:
    """Return a text without the NUL bytes that some programs write after its last line; data that
    are no text as they are. NUL bytes within a line may stand where others were lost."""
    if not data.endswith(b"\0"):
        return data
    end = data.index(b"\0")
    is_text = data.endswith(_ENDS, 0, end) and data.count(b"\0", end) == len(data) - end
    return data[:end] if is_text else data


def _unreadable(error: OSError) -> Refused:
    return Refused("unreadable-file", f"cannot be read: {error.strerror}")


def _too_large(most: int) -> Refused:
    return Refused("too-large", f"larger than {most >> 20} MiB, the most for such a file")


def open_file(path: str, location: StrPath, allowed: ReadLimits, *, whole: bool = False) -> File:
    """Return a mesh file as its reader takes it. Raises Refused, without a file name.

    path: its name in messages and reports. location: on disk. Only a file whose suffix is that of a
    reader is opened. Of a large binary STL file whose SHA-256 is not wanted only the first bytes
    are read here: its reader reads it in pieces. whole: see `File`.
    """
    size = size_of(location)
    most = allowed.file_bytes
    suffix = suffix_of(location)
    reader = reader_of(suffix)
    if reader is None:
        known = f"known are {', '.join(sorted(filter(mesh_reader, readers())))}"
        hint = _CONVERTIBLE.get(suffix.lower(), known)
        failed = failures("readers", KINDS)
        message = f"unsupported format {suffix!r}: {hint}{failed}"
        raise Refused("unsupported-format", message)
    _refuse_large(size, most)
    try:
        in_pieces = reader.name == "stl" and not allowed.hashed
        size, data = _read(location, size, most, in_pieces=in_pieces)
    except OSError as error:
        raise _unreadable(error) from None
    _refuse_large(size, most)
    digest = hashlib.sha256(data).hexdigest() if allowed.hashed else None
    if reader.text == "plain" and not _is_binary_stl(size, data):
        unmarked = _without_mark(data)
        size, data = size + len(unmarked) - len(data), unmarked
    if reader.text != "none" and not _is_binary(size, data):
        text = without_padding(data)
        size, data = size + len(text) - len(data), text
    content = _other_content(reader, size, data)
    if content is not None:
        message = f"not of format {reader.title}: its content is {content}"
        raise Refused("format-mismatch", message)
    folder, name = os.path.split(location)
    return File(
        reader.name,
        folder or os.curdir,
        name,
        data,
        size,
        values_of(reader, allowed.options),
        whole,
        permitted=allowed.permitted,
        path=path,
        sha256=digest,
    )


def _refuse_large(size: int, most: int) -> None:
    if size > most:
        message = (
            f"{size} bytes exceed the limit of {most} bytes, a quarter of the memory for one file "
            "(raise it with --megabytes-per-file)"
        )
        raise Refused("too-large", message)


def _read(location: StrPath, size: int, max_bytes: int, *, in_pieces: bool) -> tuple[int, bytes]:
    """The size and the bytes of the file, even if its size has changed, and of a system file, which
    states none; at most a byte more than max_bytes. in_pieces: of a large binary STL file only the
    first bytes are read."""
    with FileIO(location) as file:
        if in_pieces and size >= LARGE_FILE_BYTES:
            head = file.read(_TEXT_HEAD_BYTES)
            if _is_binary_stl(size, head):
                return size, head
            file.seek(0)
        data = read_file(file.fileno(), size)
        if more := file.read(1):
            data += more + read_file(file.fileno(), max_bytes - len(data))
    return len(data), data


def _without_mark(data: bytes) -> bytes:
    """Converts text with a byte order mark to UTF-8 without one."""
    if data.startswith(codecs.BOM_UTF8):
        return data[len(codecs.BOM_UTF8) :]
    for mark, encoding in _WIDE_MARKS:
        if data.startswith(mark):
            try:
                return data[len(mark) :].decode(encoding).encode()
            except UnicodeError:
                name = encoding[: len("utf-16")].upper()
                message = f"the byte order mark is that of {name}, the text is not"
                raise Refused("bad-encoding", message) from None
    return data


def _other_content(reader: Reader, size: int, data: bytes) -> str | None:
    """What the content is if it is certainly not of this format."""
    for signature, name in _SIGNATURES:
        if data.startswith(signature):
            return None if signature in reader.marks else name
    if reader.name == "stl":
        return _other_text(data)
    return "a binary STL file" if _is_binary_stl(size, data) else None


def _is_binary(size: int, data: bytes) -> bool:
    """Return whether a file of a format that may be text is not."""
    return _BINARY_PLY in data[:_TEXT_HEAD_BYTES] or _is_binary_stl(size, data)


def _is_binary_stl(size: int, data: bytes) -> bool:
    count = int.from_bytes(data[_STL_COUNT], "little")
    return count > 0 and size == _STL_HEADER_BYTES + _STL_FACET_BYTES * count


def _other_text(data: bytes) -> str | None:
    """A phrase for text that is not ASCII STL; None for STL and for data that are not text.

    Only the first bytes are read. A binary STL file has a zero byte there, because its facet count
    is less than 2^24.
    """
    head = data[:_TEXT_HEAD_BYTES]
    lines = [words for line in head.splitlines() if (words := line.split())]
    first = next((words[0] for words in lines if not words[0].startswith(b"#")), b"")
    if b"\0" in head or len(data) < _STL_HEADER_BYTES or first.lower() == b"solid":
        return None
    for known, name in _FIRST_WORDS:
        if first in known:
            return f"text that looks like {name}"
    return "text that does not start with solid"
