"""The errors of a scene file: all of them at once, each with its line and its key."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from satcheck.scene.errors import SceneFileError

if TYPE_CHECKING:
    from satcheck.scene.format.lines import Key, Keys

MOST = 20  # problems reported for one file


class Wrong(Exception):
    """A value is not what its key requires. keys: the path to the wrong part within the value."""

    def __init__(self, message: str, *keys: Key, code: str = "bad-scene") -> None:
        super().__init__(message)
        self.message = message
        self.keys = keys
        self.code = code


class Problems:
    """Collects the problems of one scene file. entries: each problem with its keys."""

    def __init__(self) -> None:
        self.entries: list[tuple[Keys, Wrong]] = []

    def __bool__(self) -> bool:
        return bool(self.entries)

    def __len__(self) -> int:
        return len(self.entries)

    def add(self, keys: Keys, wrong: Wrong) -> None:
        """keys: the path from the top of the document to the value."""
        self.entries.append(((*keys, *wrong.keys), wrong))

    def raise_any(self, path: str, lines: Callable[[Sequence[Keys]], Sequence[int]]) -> None:
        """Raises SceneFileError if there are problems: the first in the file, with the rest as
        `others`. lines: returns the line of each of these keys."""
        if not self.entries:
            return
        shown = self.entries[:MOST]
        errors = [
            SceneFileError(
                wrong.code,
                f"{dotted(keys)}: {wrong.message}" if keys else wrong.message,
                file=path,
                line=line,
            )
            for (keys, wrong), line in zip(shown, lines([keys for keys, _ in shown]), strict=True)
        ]
        errors.sort(key=lambda error: error.line or 0)
        if left := len(self.entries[MOST:]):
            errors.append(SceneFileError("bad-scene", f"{left} more errors", file=path))
        raise SceneFileError.combined(errors)


def dotted(keys: Keys) -> str:
    """`bodies[2].position`, counted from 0."""
    text = ""
    for key in keys:
        if isinstance(key, int):
            text += f"[{key}]"
        else:
            plain = key.replace("_", "").replace("-", "").isalnum()
            text += f".{key if plain else repr(key)}"
    return text.removeprefix(".")
