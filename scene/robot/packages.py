"""Where the mesh files lie that a URDF names: package://, file://, and plain paths.

A URDF may come from anywhere, so it does not choose what is opened: only what lies in its own
folder, in the ROS package around it (the nearest folder above with a package.xml), or in a folder
that the user named. Anything else needs `allow_outside`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from urllib.parse import unquote

from satcheck.scene.errors import MeshFileError

_SCHEME = re.compile(r"([a-zA-Z][a-zA-Z0-9+.-]*)://(.*)", re.DOTALL)
_PACKAGE_SCHEMES = frozenset(("package", "model"))
_MANIFEST = "package.xml"
_OR_A_ROOT = f"; so does a {_MANIFEST} in the nearest folder that holds both, the root of a package"


class MeshPlaces:
    """Resolves the mesh URIs of one URDF.

    packages: the name of a package, or of a folder in it ("name/meshes"), -> where it lies; the
    longest name that fits counts. Without one a package is looked for among the folders above the
    URDF and beside these, then in ROS_PACKAGE_PATH and AMENT_PREFIX_PATH.
    """

    def __init__(
        self,
        urdf: str,
        packages: Mapping[str, str | Path] | None = None,
        *,
        allow_outside: bool = False,
    ) -> None:
        self._folder = Path(urdf).parent
        self._packages = {name.strip("/"): Path(place) for name, place in (packages or {}).items()}
        self._allow_outside = allow_outside
        self._own = [folder.resolve() for folder in (self._folder, *_package_around(self._folder))]

    def locate(self, uri: str) -> Path:
        """The path of an existing file, relative where the URDF's was. Raises MeshFileError."""
        if "\0" in uri:
            raise MeshFileError("bad-record", f"mesh path {uri!r} holds a NUL character")
        match = _SCHEME.fullmatch(uri)
        scheme, rest = (match[1].lower(), match[2]) if match else ("", uri)
        if scheme in _PACKAGE_SCHEMES:
            return self._in_package(uri, rest.lstrip("/"))  # some write package:///name
        if scheme not in ("", "file"):
            raise MeshFileError("unsupported-feature", f"{uri}: {scheme}:// is not fetched")
        place = _tidy(self._folder / (unquote(rest) if scheme else rest))
        if not place.is_file():
            raise MeshFileError("missing-resource", f"mesh file {uri!r} is missing (no {place})")
        if not self._may_open(place):
            raise MeshFileError(
                "outside-path", f"{self._outside(uri, place)}: --allow-outside lets it{_OR_A_ROOT}"
            )
        return place

    def _in_package(self, uri: str, rest: str) -> Path:
        name, _, inner = rest.partition("/")
        if named := self._named(rest):
            if not named.is_file():
                raise MeshFileError("missing-resource", f"{uri}: there is no {named}")
            return named
        found = [folder for folder in self._candidates(name) if folder.is_dir()]
        places = [place for folder in found if (place := _tidy(folder / inner)).is_file()]
        for place in places:
            if self._may_open(place) or _is_from_environment(place):
                return place
        give = f"--package {name}=DIR"
        if places:
            leave = f"--allow-outside or {give} lets it{_OR_A_ROOT}"
            message = f"{self._outside(uri, places[0])}: {leave}"
            raise MeshFileError("outside-path", message)
        looked = f"there is no {_tidy(found[0] / inner)}" if found else "the package is not found"
        raise MeshFileError("missing-resource", f"{uri}: {looked}: {give} says where it lies")

    def _named(self, rest: str) -> Path | None:
        """By the user's own mapping, which is trusted as far as its folder reaches."""
        parts = rest.split("/")
        for length in range(len(parts), 0, -1):
            folder = self._packages.get("/".join(parts[:length]))
            if folder is not None:
                place = _tidy(folder.joinpath(*parts[length:]))
                if not self._allow_outside and not _within(place, folder.resolve()):
                    raise MeshFileError(
                        "outside-path", f"package://{rest} leaves {folder}: refused"
                    )
                return place
        return None

    def _candidates(self, name: str) -> Iterator[Path]:
        absolute = self._folder.absolute()
        for steps, above in enumerate((absolute, *absolute.parents)):
            folder = _tidy(self._folder.joinpath(*[".."] * steps))
            if above.name == name:
                yield folder
            yield folder / name
        for root in _environment():
            yield root if root.name == name else root / name

    def _may_open(self, place: Path) -> bool:
        return self._allow_outside or any(_within(place, folder) for folder in self._own)

    def _outside(self, uri: str, place: Path) -> str:
        return f"{uri} is {place}, outside the folder of the URDF"


def _package_around(folder: Path) -> list[Path]:
    absolute = folder.absolute()
    around = (absolute, *absolute.parents)
    return [above for above in around if (above / _MANIFEST).is_file()][:1]


def _environment() -> list[Path]:
    """Folders of packages, as ROS 1 and ROS 2 are told about them."""
    ros = os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep)
    ament = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return [Path(entry) for entry in ros if entry] + [Path(e) / "share" for e in ament if e]


def _is_from_environment(place: Path) -> bool:
    return any(_within(place, root.resolve()) for root in _environment())


def _within(place: Path, folder: Path) -> bool:
    return place.resolve().is_relative_to(folder)


def _tidy(path: Path) -> Path:
    return Path(os.path.normpath(path))
