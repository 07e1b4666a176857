"""How the files of inputs are opened.

Only regular files are opened, no larger than a share of the memory for reading one; what a file
unpacks to counts as a file. Of a mesh file the bytes are read once, hashed, and its suffix and
content are checked.

`Path.is_dir` and its siblings raise OSError for a name that is too long, and for one in a folder
that may not be searched. Those here say no, and whatever reads or writes the path says why.
"""

from __future__ import annotations

import codecs
import hashlib
import os
import re
import stat
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from satcheck._native.readers import read_file
from satcheck.scene.access import (
    NOTHING_ELSE,
    OWN_FILE,
    Context,
    Most,
    Permitted,
    StrPath,
    no_file,
    note,
    note_bytes,
    note_digest,
)
from satcheck.scene.errors import Refused

if TYPE_CHECKING:
    from satcheck.scene.files.readers import Reader, ReadOptions

    Block = bytes | memoryview
else:
    Block = memoryview  # the type that msgspec decodes to

DEFAULT_SECONDS_PER_FILE = 60.0

is_folder = os.path.isdir
is_file = os.path.isfile
exists = os.path.exists


def name_of(path: StrPath) -> tuple[str, str]:
    """Return the stem and the suffix of the last name, as `Path` does in ten times the time."""
    name = os.fspath(path).rstrip("/").rpartition("/")[2].rpartition(os.sep)[2]
    dot = name.rfind(".")
    return (name[:dot], name[dot:]) if 0 < dot < len(name) - 1 else (name, "")


def suffix_of(path: StrPath) -> str:
    return name_of(path)[1]


class File(Struct, frozen=True):
    """A file that is open for a reader. It can be sent to a child process.

    directory: that its references are relative to. name: in the directory. data: its bytes, text as
    UTF-8 without a byte order mark and padding; of a format that is `by_name`, none. whole: its
    nodes are not wanted, so a reader need not tell them apart. permitted: where what it names may
    lie, beside the directory. isolated: this process may crash. path: as given, for messages.
    sha256: of the file, hex; None: not wanted. packages: of a robot, see `robot.FilePlaces`.
    options: all that its reader declares, by name.
    """

    format: str
    directory: str
    name: str
    data: Block
    options: Mapping[str, Any] = {}
    whole: bool = False
    permitted: Permitted = NOTHING_ELSE
    isolated: bool = False
    path: str = ""
    sha256: str | None = None
    packages: Mapping[str, str | Path] = {}

    @property
    def location(self) -> Path:
        return Path(self.directory, self.name)

    @property
    def context(self) -> Context:
        """Return what it may name."""
        return Context(self.directory, self.permitted)


class ReadLimits(Struct, frozen=True):
    """Limits and options for reading one file.

    permitted: how large it may be, and where the files may lie that it refers to. hashed: whether
    its SHA-256 is needed. options: those that are given, of any reader.
    """

    seconds: float = DEFAULT_SECONDS_PER_FILE
    permitted: Permitted = NOTHING_ELSE
    hashed: bool = True
    options: ReadOptions = {}

    @property
    def key(self) -> tuple[object, ...]:
        """Return what can be a key, the same for equal limits."""
        return (self.seconds, self.permitted, self.hashed, *sorted(self.options.items()))


STANDARD_INPUT = "-"
_ENDS = (b"\n", b"\r", b"}", b">")  # of a line, JSON, XML

# The longer marks first: the mark of UTF-32 begins like that of UTF-16.
_WIDE_MARKS = (
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_ANY_MARK = (codecs.BOM_UTF8, *(mark for mark, _ in _WIDE_MARKS))

LARGE_FILE_BYTES = 1_000_000  # larger files get their own thread
_STL_HEADER_BYTES = 84
_STL_FACET_BYTES = 50
_STL_COUNT = slice(80, 84)

# The first bytes of files that are often misnamed as meshes, and what they are. The marks of a
# reader say which of them its files may have.
_SIGNATURES = {
    b"\x89PNG\r\n": "a PNG image",
    b"\xff\xd8\xff": "a JPEG image",
    b"GIF8": "a GIF image",
    b"%PDF": "a PDF document",
    b"\x1f\x8b": "gzip data",
    b"\x7fELF": "an ELF program",
    b"version https://git-lfs": "a Git LFS pointer: git lfs pull fetches the file",
    b"glTF": "a GLB file",
    b"ISO-10303-21;": "a STEP file",
    b"PK\x03\x04": "a zip archive",
    b"ply\n": "a PLY file",
    b"ply\r\n": "a PLY file",
}
_MARKS = tuple(_SIGNATURES)

# The words at the start of lines in a text format, without comments.
_FIRST_WORDS = (
    ((b"v", b"vn", b"vt", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl"), "an OBJ file"),
    ((b"OFF", b"COFF", b"NOFF", b"CNOFF", b"STOFF"), "an OFF file"),
    ((b"ply",), "a PLY file"),
    ((b"<?xml", b"<COLLADA"), "an XML file"),
    ((b"{",), "a JSON file"),
)
_FIRST_WORD = re.compile(rb"(?:\s*+#[^\r\n]*+)*+\s*+([^\s]++)")  # that is no comment
_TEXT_HEAD_BYTES = 4096
_READ = os.O_RDONLY | getattr(os, "O_BINARY", 0)  # `FileIO` takes twice as long
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
    if not stat.S_ISREG(status.st_mode) and (special := no_file(location)):
        raise special
    return status.st_size


def read_whole(path: StrPath, most: Most = OWN_FILE) -> bytes:
    """The bytes of a text file, without padding; but of TOML as they are, because no mark ends its
    last table, and NUL bytes may stand where more tables were lost. Raises Refused, with the path,
    if it is not a regular file, is too large, or cannot be read."""
    try:
        data = _read(path, size_of(path), most)
        note_bytes(path, data)
        return data if suffix_of(path).lower() == ".toml" else without_padding(data)
    except Refused as error:
        raise Refused(error.code, error.message, file=os.fspath(path)) from None


def without_padding(data: bytes) -> bytes:
    """Return a text without the NUL bytes that some programs write after its last line; data that
    are no text as they are. NUL bytes within a line may stand where others were lost."""
    if not data.endswith(b"\0") or _BINARY_PLY in data[:_TEXT_HEAD_BYTES]:
        return data
    end = data.index(b"\0")
    is_text = data.endswith(_ENDS, 0, end) and data.count(b"\0", end) == len(data) - end
    return data[:end] if is_text else data


def _unreadable(error: OSError) -> Refused:
    return Refused("unreadable-file", f"cannot be read: {error.strerror}")


def open_file(
    path: str,
    location: StrPath,
    find: Callable[[str], Reader],
    allowed: ReadLimits,
    *,
    whole: bool = False,
) -> tuple[Reader, File]:
    """Return the reader of a mesh file, and the file as it takes it. Raises Refused, without a file
    name.

    path: its name in messages and reports. location: on disk. find: returns the reader of a suffix,
    or raises Refused. whole: see `File`.
    """
    size = size_of(location)
    reader = find(suffix_of(location))
    data = _read(location, size, allowed.permitted.most)
    digest = hashlib.sha256(data).hexdigest() if allowed.hashed else None
    if digest is not None:
        note_digest(location, digest)
    is_stl = _is_binary_stl(data)
    if reader.text == "plain" and not is_stl:
        data = _without_mark(data)
    if reader.text != "none" and not is_stl:
        data = without_padding(data)
    content = _other_content(reader, data, is_stl=is_stl)
    if content is not None:
        message = f"not of format {reader.title}: its content is {content}"
        raise Refused("format-mismatch", message)
    folder, name = os.path.split(location)
    return reader, File(
        reader.name,
        folder or os.curdir,
        name,
        data,
        reader.values(allowed.options),
        whole,
        permitted=allowed.permitted,
        path=path,
        sha256=digest,
    )


def _read(location: StrPath, size: int, most: Most) -> bytes:
    """The bytes of the file, even if its size has changed, and of a system file, which states none.
    Raises Refused."""
    most.refuse_beyond(size)
    try:
        file = os.open(location, _READ)
        try:
            data = read_file(file, size)
            if more := os.read(file, 1):
                data += more + read_file(file, most.size - len(data))
        finally:
            os.close(file)
    except OSError as error:
        raise _unreadable(error) from None
    most.refuse_beyond(len(data))
    return data


def _without_mark(data: bytes) -> bytes:
    """Converts text with a byte order mark to UTF-8 without one."""
    if not data.startswith(_ANY_MARK):
        return data
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


def _other_content(reader: Reader, data: bytes, *, is_stl: bool) -> str | None:
    """What the content is if it is certainly not of this format. is_stl: it is binary STL."""
    if data.startswith(_MARKS):
        signature = next(filter(data.startswith, _SIGNATURES))
        return None if signature in reader.marks else _SIGNATURES[signature]
    if reader.name == "stl":
        return _other_text(data)
    return "a binary STL file" if is_stl else None


def _is_binary_stl(data: bytes) -> bool:
    count, rest = divmod(len(data) - _STL_HEADER_BYTES, _STL_FACET_BYTES)
    return count > 0 and not rest and count == int.from_bytes(data[_STL_COUNT], "little")


def _other_text(data: bytes) -> str | None:
    """A phrase for text that is not ASCII STL; None for STL and for data that are not text.

    Only the first bytes are read. A binary STL file has a zero byte there, because its facet count
    is less than 2^24.
    """
    head = data[:_TEXT_HEAD_BYTES]
    match = _FIRST_WORD.match(head)
    first = match[1] if match else b""
    if b"\0" in head or len(data) < _STL_HEADER_BYTES or first.lower() == b"solid":
        return None
    for known, name in _FIRST_WORDS:
        if first in known:
            return f"text that looks like {name}"
    return "text that does not start with solid"
