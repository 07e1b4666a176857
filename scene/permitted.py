"""Decides which files the files of a call may name."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Self

from msgspec import Struct

from satcheck.scene.path_kind import followed


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
