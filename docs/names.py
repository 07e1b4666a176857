"""Write docs/reference.md, of the registries and the settings: `python -m docs.names`.

A list stands between `<!-- names: readers -->` and `<!-- end of names -->`.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from textwrap import TextWrapper

from msgspec.structs import fields

from satcheck.audit.settings import Settings
from satcheck.cli.formats.registry import formats
from satcheck.decompose import ENGINES
from satcheck.scene.files.readers import GEOMETRY, Reader, options, readers, robots

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "reference.md"
_LIST = re.compile(r"(<!-- names: (\w+) -->\n).*?(<!-- end of names -->)", re.DOTALL)
_WRAPPER = TextWrapper(140, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
_PLUGIN = re.compile(r"satcheck\.plugins\.(\w+)\.")


def read() -> Iterator[str]:
    """Yield each format that is read: the endings of its files, what to install, its options."""
    known = {reader.title: reader for reader in (*readers().values(), *robots().values())}
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    for title, reader in sorted(known.items(), key=lambda item: item[0].lower()):
        extra = _PLUGIN.match(reader.read)
        needs = extra is not None and extra[1] in extras["optional-dependencies"]
        install = f"; `[{extra[1]}]`" if extra and needs else ""
        yield f"- {title}: {_code(reader.endings)}{install}{_defaults(reader)}"


def _defaults(reader: Reader) -> str:
    stated = [
        option.spelling if option.default is None else f"{option.spelling}={_plain(option.default)}"
        for option in reader.options
        if option is not GEOMETRY
    ]
    return f"; {_code(stated)}" if stated else ""


def options_of_readers() -> Iterator[str]:
    for option, _ in options().values():
        if option is not GEOMETRY:
            yield f"- `{option.spelling}`: {option.help}"


def written() -> Iterator[str]:
    """Yield each format of reports with the endings that choose it."""
    for form in formats().values():
        if form.endings:
            about = f": {form.about}" if form.about else ""
            yield f"- `{form.name}` ({_code(form.endings)}){about}"


def settings() -> Iterator[str]:
    yield _code(f"{field.name}={field.default!r}" for field in fields(Settings))


def engines() -> Iterator[str]:
    """Yield each engine with the limits of --for, where they are from, and the files it reads."""
    for name, known in ENGINES.items():
        parts = f"{known.parts} parts, " if known.parts else ""
        yield f"- `{name}`: {parts}{known.vertices} vertices ({known.why}); reads {known.files}"


LISTS: Mapping[str, Callable[[], Iterator[str]]] = {
    "read": read,
    "options": options_of_readers,
    "written": written,
    "settings": settings,
    "engines": engines,
}


def filled(page: str) -> str:
    """Return the text of the page with the lists of the code."""
    return _LIST.sub(lambda m: f"{m[1]}\n{text_of(m[2])}\n\n{m[3]}", page)


def text_of(name: str) -> str:
    return "\n".join(line for item in LISTS[name]() for line in _WRAPPER.wrap(item))


def _code(words: Iterable[str]) -> str:
    return ", ".join(f"`{word}`" for word in words)


def _plain(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else f"{value}"


def main() -> None:
    PAGE.write_text(filled(PAGE.read_text("utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
