"""Paths: what is there, which folders the environment names, and which files an input may name.

`Path.is_dir` and its siblings raise OSError for a name that is too long, and for one in a folder
that may not be searched. Those here say no, and whatever reads or writes the path says why.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Self

from msgspec import Struct

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
    name = os.path.basename(os.fspath(path).rstrip("/"))  # noqa: PTH119
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


class Permitted(Struct, frozen=True):
    """A file may name what lies in its own folder, and in these folders, which are without links.

    anywhere: all other files too.
    """

    folders: tuple[str, ...] = ()
    anywhere: bool = False

    @classmethod
    def around(
        cls,
        paths: Iterable[str | Path],
        given: Sequence[str | Path],
        *,
        anywhere: bool = False,
    ) -> Self:
        """given: folders that the user named. Those count that one of these files lies in, so that
        no answer depends on what else is checked."""
        if anywhere or not given:
            return cls(anywhere=anywhere)
        places = [followed(Path(path).parent) for path in paths]
        folders = dict.fromkeys(followed(Path(folder)) for folder in given)
        around = [each for each in folders if any(place.is_relative_to(each) for place in places)]
        return cls(tuple(sorted(map(str, around))))

    def has(self, place: Path, own: Path) -> bool:
        """own: the folder of the file that names it, without links."""
        if self.anywhere:
            return True
        real = followed(place)
        return real.is_relative_to(own) or any(map(real.is_relative_to, self.folders))

    def beyond(self, own: str) -> str:
        """Return where a file lies that is not permitted. own: the folder in words."""
        given = " and ".join(self.folders)
        return f"outside {own}, and of {given}" if given else f"outside {own}"


NOTHING_ELSE = Permitted()
ANYWHERE = Permitted(anywhere=True)
