"""What is said once of many prims."""

from __future__ import annotations

from collections.abc import Iterator


class Remarks:
    """Collects prims by what is said of them, for one warning each."""

    def __init__(self) -> None:
        self._names: dict[tuple[str, str], list[str]] = {}

    def add(self, code: str, words: str, name: str) -> None:
        """words: after the name of prims and a colon."""
        self._names.setdefault((code, words), []).append(name)

    def warnings(self) -> Iterator[tuple[str, str]]:
        for (code, words), names in self._names.items():
            others = f" and {len(names) - 1} more" if len(names) > 1 else ""
            yield code, f"{names[0]}{others}: {words}"
