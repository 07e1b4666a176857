"""The files of inputs: what is there, which files an input may name, and how they are opened.

Only regular files are opened, no larger than a share of the memory for reading one; what a file
unpacks to counts as a file. Whatever opens an input, or asks whether it
is there, notes it for callers that keep results of a check; nothing depends on whether anybody
listens. A child process cannot note for its parent: its answer names what it has read. Of a mesh
file the bytes are read once, hashed, and its suffix and content are checked.

`Path.is_dir` and its siblings raise OSError for a name that is too long, and for one in a folder
that may not be searched. Those here say no, and whatever reads or writes the path says why.
"""

from __future__ import annotations

import codecs
import hashlib
import os
import re
import stat
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property
from io import FileIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Self

from msgspec import Struct, field

from satcheck._native.readers import read_file
from satcheck.scene.errors import Refused
from satcheck.scene.files.limits import BYTES_PER_MEGABYTE

if TYPE_CHECKING:
    from satcheck.scene.files.readers import Reader, ReadOptions

    Block = bytes | memoryview
else:
    Block = memoryview  # the type that msgspec decodes to

DEFAULT_SECONDS_PER_FILE = 60.0
DEFAULT_MEGABYTES_PER_FILE = 2048

# With folders that hold packages, models or files.
_VARIABLES = (
    "ROS_PACKAGE_PATH",
    "GAZEBO_MODEL_PATH",
    "GAZEBO_RESOURCE_PATH",
    "GZ_SIM_RESOURCE_PATH",
    "IGN_GAZEBO_RESOURCE_PATH",
    "SDF_PATH",
)
_AMENT = "AMENT_PREFIX_PATH"  # the packages are in `share` of its folders

StrPath = str | os.PathLike[str]
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


def followed(path: Path) -> Path:
    """The path without links. `Path.resolve` raises for a path that leads in a circle, and for one
    that no system accepts. Here they stay as they are: they cannot be opened."""
    try:
        return Path(os.path.realpath(path))
    except ValueError:
        return path.absolute()


def search_path() -> tuple[str, ...]:
    """The values of these variables."""
    return tuple(os.environ.get(name, "") for name in (_AMENT, *_VARIABLES))


def folders_of_environment() -> list[Path]:
    ament, *others = (text.split(os.pathsep) for text in search_path())
    plain = [Path(entry) for entries in others for entry in entries if entry]
    return plain + [Path(entry) / "share" for entry in ament if entry]


class Most(NamedTuple):
    """The most bytes of a file, or of what it unpacks to. why: what they are, and what to do."""

    size: int
    why: str

    def refuse_beyond(self, size: int, what: str = "") -> None:
        """Raises Refused for a larger size. what: has it, unless it is the file."""
        if size > self.size:
            message = f"{size} bytes exceed the limit of {self.size} bytes, {self.why}"
            raise Refused("too-large", f"{what}: {message}" if what else message)


# Of what satcheck writes, and of settings; the user names the file.
OWN_FILE = Most(1 << 30, "the most for such a file: write less into it")


_OF_MEMORY = " of the memory for one file (raise it with --limit megabytes=N)"


class Permitted(Struct, frozen=True, dict=True):
    """A file may name what lies in its own folder, and in these folders, which are without links.

    anywhere: all other files too. megabytes: of memory for reading one.
    """

    folders: tuple[str, ...] = ()
    anywhere: bool = False
    megabytes: int = DEFAULT_MEGABYTES_PER_FILE

    @cached_property
    def most(self) -> Most:
        """Return the limit of any file: reading a text takes about three times its size."""
        return self._share(4, "a quarter")

    @property
    def most_of_tree(self) -> Most:
        """Return that of XML that becomes a tree of objects in this process, which takes about
        twenty times its size."""
        return self._share(32, "a 32nd")

    def _share(self, count: int, named: str) -> Most:
        return Most(self.megabytes * BYTES_PER_MEGABYTE // count, named + _OF_MEMORY)

    @classmethod
    def around(
        cls,
        paths: Iterable[str | Path],
        given: Sequence[str | Path],
        *,
        anywhere: bool = False,
        megabytes: int = DEFAULT_MEGABYTES_PER_FILE,
    ) -> Self:
        """given: folders that the user named. Those count that one of these files lies in, so that
        no answer depends on what else is checked."""
        if anywhere or not given:
            return cls(anywhere=anywhere, megabytes=megabytes)
        places = [followed(Path(path).parent) for path in paths]
        folders = dict.fromkeys(followed(Path(folder)) for folder in given)
        around = [each for each in folders if any(place.is_relative_to(each) for place in places)]
        return cls(tuple(sorted(map(str, around))), megabytes=megabytes)


NOTHING_ELSE = Permitted()
ANYWHERE = Permitted(anywhere=True)


# Of a file: what changes when its content does; the last two are times. None: nothing is there, or
# nobody may look.
Signature = tuple[int, ...] | None
# A file that changed this recently may change again within the grain of its times.
_GRAIN_NS = 2_000_000_000
_status = os.stat


class FilesRead(Struct, eq=False):
    """The files that a check has read or looked for, in that order.

    signatures: when they were noted. `folder/` stands for the names of the folders in it. digests:
    SHA-256, hex, of the bytes, if it was made as they were read. are_all: False: a process died
    that may have read others.
    """

    signatures: dict[str, Signature] = {}
    digests: dict[str, str] = {}
    are_all: bool = True
    began_ns: int = field(default_factory=time.time_ns)

    def __iter__(self) -> Iterator[str]:
        return iter(self.signatures)

    def are_certain(self) -> bool:
        """Whether these are all files, and none has changed since it was noted."""
        known = self.signatures.items()
        return self.are_all and all(signature(name) == at for name, at in known)

    def are_settled(self) -> bool:
        """Whether these are all files, and each change since they were noted will show in a
        signature."""
        return self.are_all and all(map(self.is_settled, self))

    def is_settled(self, name: str) -> bool:
        at = self.signatures[name]
        return at is None or max(at[-2:]) < self.began_ns - _GRAIN_NS

    def note_again(self) -> None:
        for name in self:
            note(name)
        for name, digest in self.digests.items():
            _note_digest(name, digest)


_listening: list[FilesRead] = []


def note(location: str | Path) -> None:
    """location: of a file that the answer depends on, even if it is not there."""
    if not _listening:
        return
    name, known = os.fspath(location), _listening[0].signatures
    at = known[name] if name in known else signature(name)
    for listener in _listening:
        listener.signatures.setdefault(name, at)


def _note_digest(location: StrPath, digest: str) -> None:
    for listener in _listening:
        listener.digests[str(location)] = digest


def note_folders_in(folder: Path) -> None:
    """The answer depends on the names of the folders in this one."""
    note(f"{folder}/")


def note_lost_reader() -> None:
    """A process died that may have read files which nobody knows."""
    for listener in _listening:
        listener.are_all = False


@contextmanager
def files_read() -> Iterator[FilesRead]:
    """The files noted while it lasts."""
    files = FilesRead()
    _listening.append(files)
    try:
        yield files
    finally:
        _listening.remove(files)


def signature(name: str) -> Signature:
    try:
        status = _status(name)
    except (OSError, ValueError):
        return None
    return (
        status.st_dev,
        status.st_ino,
        status.st_mode,
        status.st_size,
        status.st_mtime_ns,
        status.st_ctime_ns,
    )


def _is_plain_file(place: StrPath) -> bool:
    """Return whether it is a file, and no link to one."""
    try:
        return stat.S_ISREG(os.lstat(place).st_mode)
    except (OSError, ValueError):
        return False


class Context:
    """The files that one file may name.

    folder: that their names are relative to. package: a folder all of whose files it may name;
    None: its own. words: which folder that is.
    """

    def __init__(
        self,
        folder: StrPath,
        permitted: Permitted,
        package: Path | None = None,
        words: str = "the file's folder",
    ) -> None:
        self._folder = os.fspath(folder)
        self.permitted = permitted
        self._package = package
        self._words = words
        self._start = "" if self._folder == os.curdir else self._folder
        self._followed: dict[str, str] = {}  # folder -> the same without links

    @cached_property
    def own(self) -> Path:
        """The folder all of whose files it may name, without links."""
        return followed(self._package or Path(self._folder))

    @cached_property
    def _folders(self) -> tuple[str, ...]:
        # The folder of the file, where a link leads to it, may lie outside of its package.
        own = (str(self.own), str(followed(Path(self._folder))), *self.permitted.folders)
        return tuple(folder.rstrip(os.sep) + os.sep for folder in own)

    def permits(self, place: StrPath, *, is_plain: bool = False) -> bool:
        """Return whether the file may name this one. is_plain: it is known to be no link."""
        if self.permitted.anywhere:
            return True
        folder, name = os.path.split(place)
        if name in ("", os.curdir, os.pardir) or not (is_plain or _is_plain_file(place)):
            return f"{followed(Path(place))}{os.sep}".startswith(self._folders)
        if folder not in self._followed:
            self._followed[folder] = str(followed(Path(folder))).rstrip(os.sep)
        return f"{self._followed[folder]}{os.sep}{name}{os.sep}".startswith(self._folders)

    def refusal(
        self, what: str, advice: str = "refused (allow it with --allow-outside)"
    ) -> Refused:
        """Return the error for a file that is not permitted. what: it is, with its name."""
        where = " and of ".join((self._words, *self.permitted.folders))
        return Refused("outside-path", f"{what} lies outside of {where}: {advice}")

    def find(self, what: str, name: str) -> str:
        """Return where a file lies that is named. what: as above. Raises Refused."""
        if "\0" in name:
            raise Refused("bad-record", f"the path of {what} holds a NUL character")
        # As `Path` joins them, which takes long.
        is_tidy = "./" not in name and "//" not in name
        place = os.path.join(self._start, name) if is_tidy else str(Path(self._folder, name))  # noqa: PTH118
        note(place)
        is_plain = _is_plain_file(place)
        if not self.permits(place, is_plain=is_plain):
            raise self.refusal(what)
        if not is_plain and not is_file(place):
            raise no_file(place, f"{what} ") or Refused("missing-resource", f"{what} is missing")
        return place

    @contextmanager
    def open(self, what: str, name: str) -> Iterator[tuple[FileIO, int]]:
        """Open such a file, and yield it with its size. Raises Refused, also while it is read."""
        place = self.find(what, name)
        try:
            with FileIO(place) as file:
                size = os.fstat(file.fileno()).st_size
                self.permitted.most.refuse_beyond(size, what)
                yield file, size
        except OSError as error:
            message = f"{what} cannot be read: {error.strerror}"
            raise Refused("unreadable-file", message) from None


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

# Opening one of these may block, or reading it may never end.
_SPECIAL = (
    (stat.S_ISDIR, "a directory"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)
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


def no_file(location: StrPath, what: str = "") -> Refused | None:
    """Return the error for a place with something else than a file; None: it has a file, or
    nothing. what: words for the place, with a space behind."""
    try:
        mode = os.stat(location).st_mode  # noqa: PTH116
    except (OSError, ValueError):
        return None
    if stat.S_ISREG(mode):
        return None
    kind = next((name for test, name in _SPECIAL if test(mode)), "a special file")
    return Refused("not-a-file", f"{what}is {kind}, not a file")


def read_whole(path: str, location: StrPath, most: Most = OWN_FILE) -> bytes:
    """The bytes of a text file, without padding. Raises Refused, with the path, if it is not a
    regular file, is too large, or cannot be read."""
    try:
        data = _read(location, size_of(location), most)
        if _listening:
            _note_digest(location, hashlib.sha256(data).hexdigest())
        return without_padding(data)
    except Refused as error:
        raise Refused(error.code, error.message, file=path) from None


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
        _note_digest(location, digest)
    is_stl = _is_binary_stl(data)
    if reader.text == "plain" and not is_stl:
        data = _without_mark(data)
    if reader.text != "none" and not is_stl and _BINARY_PLY not in data[:_TEXT_HEAD_BYTES]:
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
