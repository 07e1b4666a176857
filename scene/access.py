"""Which files a check may read, and which it has read: its answer depends on them.

Whatever opens an input, or asks whether it is there, notes it for callers that keep results of a
check; nothing depends on whether anybody listens. A child process cannot note for its parent: its
answer names what it has read.
"""

from __future__ import annotations

import hashlib
import os
import stat
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property
from io import FileIO
from pathlib import Path
from typing import NamedTuple, Self

from msgspec import Struct, field

from satcheck.scene.errors import Refused
from satcheck.scene.files.limits import BYTES_PER_MEGABYTE
from satcheck.scene.words import quoted

StrPath = str | os.PathLike[str]

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
# Of a file: what changes when its content does; the last two are times. None: nothing is there, or
# nobody may look.
Signature = tuple[int, ...] | None
# A file that changed this recently may change again within the grain of its times.
_GRAIN_NS = 2_000_000_000
_status = os.stat


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
# Opening one of these may block, or reading it may never end.
_SPECIAL = (
    (stat.S_ISDIR, "a directory"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def _is_plain_file(place: StrPath) -> bool:
    """Return whether it is a file, and no link to one."""
    try:
        return stat.S_ISREG(os.lstat(place).st_mode)
    except (OSError, ValueError):
        return False


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

    def find(self, noun: str, name: str) -> str:
        """Return where a file lies that is named. noun: what it is. Raises Refused."""
        if "\0" in name:
            raise Refused("bad-record", f"the path of {noun} {quoted(name)} holds a NUL character")
        # As `Path` joins them, which takes long.
        is_tidy = "./" not in name and "//" not in name
        place = os.path.join(self._start, name) if is_tidy else str(Path(self._folder, name))  # noqa: PTH118
        note(place)
        is_plain = _is_plain_file(place)
        if not self.permits(place, is_plain=is_plain):
            raise self.refusal(f"{noun} {quoted(name)}")
        if is_plain or os.path.isfile(place):  # noqa: PTH113
            return place
        what = f"{noun} {quoted(name)}"
        raise no_file(place, f"{what} ") or Refused("missing-resource", f"{what} is missing")

    @contextmanager
    def open(self, noun: str, name: str) -> Iterator[tuple[FileIO, int]]:
        """Open such a file, and yield it with its size. Raises Refused, also while it is read."""
        place, what = self.find(noun, name), f"{noun} {quoted(name)}"
        try:
            with FileIO(place) as file:
                size = os.fstat(file.fileno()).st_size
                self.permitted.most.refuse_beyond(size, what)
                yield file, size
        except OSError as error:
            message = f"{what} cannot be read: {error.strerror}"
            raise Refused("unreadable-file", message) from None


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
            note_digest(name, digest)


_listening: list[FilesRead] = []


def note(location: str | Path) -> None:
    """location: of a file that the answer depends on, even if it is not there."""
    if not _listening:
        return
    name, known = os.fspath(location), _listening[0].signatures
    at = known[name] if name in known else signature(name)
    for listener in _listening:
        listener.signatures.setdefault(name, at)


def note_digest(location: str | os.PathLike[str], digest: str) -> None:
    for listener in _listening:
        listener.digests[str(location)] = digest


def note_bytes(location: str | os.PathLike[str], data: bytes) -> None:
    """data: the bytes of this file, as they were read."""
    if _listening:
        note_digest(location, hashlib.sha256(data).hexdigest())


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
