"""Write the lists of names into docs/formats.md and pages of plug-ins: `python -m docs.names`.

They are the tables that the readers ask. A list stands between `<!-- names: gltf -->` and
`<!-- end of names -->`.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from textwrap import TextWrapper

from satcheck.plugins.sdf import places as sdf
from satcheck.plugins.step import exchange as step
from satcheck.plugins.usd import names as usd
from satcheck.scene.files import gltf_colliders, gltf_document, threemf_vocabulary
from satcheck.scene.files.readers import GEOMETRY, options
from satcheck.scene.robot import srdf, urdf_places
from satcheck.scene.robot.slips import Place
from satcheck.scene.vocabulary import Names

ROOT = Path(__file__).resolve().parents[1]
# The same first two words, as of the extensions of one vendor for materials.
_PREFIX = re.compile(r"[A-Z0-9]+_[a-z]+_")
_FEWEST = 3  # names that have their prefix once
_IDLE = "if it is"
_WRAPPER = TextWrapper(140, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)


def gltf() -> Iterator[str]:
    extensions = gltf_document.EXTENSIONS_OF.items()
    read = {f"{place} extensions": names for place, names in extensions}
    yield from _read({**read, **gltf_colliders.PLACES})
    yield from _harmless("properties", {**gltf_document.PLACES, **gltf_colliders.PLACES})
    yield from _harmless("extensions", {"file": gltf_document.EXTENSIONS})


def threemf() -> Iterator[str]:
    attributes, children = threemf_vocabulary.ATTRIBUTES, threemf_vocabulary.CHILDREN
    none = Names(frozenset())
    tags = dict.fromkeys((*attributes, *children))
    yield from _lists(
        {f"`{tag}`": _both(children.get(tag, none), attributes.get(tag, none)) for tag in tags}
    )


def urdf() -> Iterator[str]:
    robot, joint = urdf_places.ROBOT, urdf_places.JOINT
    shapes = {"collision, visual": urdf_places.SHAPE}
    yield from _lists(_flat({"robot": robot, "link": urdf_places.LINK, **shapes, "joint": joint}))


def srdf_names() -> Iterator[str]:
    yield from _lists(_flat({"robot": srdf.ROBOT}))


def sdf_names() -> Iterator[str]:
    places = ("WORLD", "MODEL", "INCLUDE", "LINK", "FRAME", "JOINT", "STATE")
    roots = {name.lower(): getattr(sdf, name) for name in places}
    yield from _lists(_flat({"sdf": sdf.ROOT, **roots, "collision, visual": sdf.SHAPE}))


def usd_names() -> Iterator[str]:
    schemas = {"API schemas": usd.APIS, "types": usd.TYPES}
    yield from _read(schemas)
    for kind, names in schemas.items():
        yield from _harmless(kind, {kind: names})


def step_names() -> Iterator[str]:
    yield from _item("refused if the file has no other faces", step.TESSELLATED)


def options_of_readers() -> Iterator[str]:
    for option, titles in options().values():
        if option is not GEOMETRY:
            item = f"- `{option.spelling}` ({', '.join(titles)}): {option.help}"
            yield from _WRAPPER.wrap(item)


LISTS: Mapping[str, Callable[[], Iterator[str]]] = {
    "options": options_of_readers,
    "gltf": gltf,
    "3mf": threemf,
    "urdf": urdf,
    "srdf": srdf_names,
    "sdf": sdf_names,
    "usd": usd_names,
    "step": step_names,
}
PAGES = (
    ROOT / "docs/formats.md",
    *(ROOT / "plugins" / name / "README.md" for name in ("sdf", "step", "usd")),
)
_LIST = re.compile(r"(<!-- names: (\w+) -->\n).*?(<!-- end of names -->)", re.DOTALL)


def filled(page: str) -> str:
    """Return the text of a page with the lists of the code."""
    return _LIST.sub(lambda m: f"{m[1]}\n{text_of(m[2])}\n\n{m[3]}", page)


def text_of(name: str) -> str:
    return "\n".join(LISTS[name]())


def _flat(roots: Mapping[str, Place]) -> dict[str, Names]:
    """Return the names of each element, also of the elements inside. An attribute ends in `=`."""
    places: dict[str, Names] = {}

    def add(label: str, place: Place) -> None:
        # Without a list of elements the reader makes an unreadable body of others.
        elements = place.elements or Names(frozenset(place.inside))
        idle = {name: f"{_IDLE} {_value(value)}" for name, value in place.idle.items()}
        elements = Names(elements.read, {**elements.harmless, **idle})
        names = _both(elements, place.attributes)
        places[label if places.get(label, names) == names else f"{label} in it"] = names
        for tag, inner in place.inside.items():
            add(f"`{tag}`", inner)

    for tags, place in roots.items():
        add(_code(tags.split(", ")), place)
    return places


def _value(value: float | str) -> str:
    return f"{value:g}" if isinstance(value, float) else f"`{value}`" if value else "empty"


def _both(elements: Names, attributes: Names) -> Names:
    read = elements.read | {f"{name}=" for name in attributes.read}
    of_attributes = {f"{name}=": why for name, why in attributes.harmless.items()}
    return Names(read, {**elements.harmless, **of_attributes})


def _lists(places: Mapping[str, Names]) -> Iterator[str]:
    yield from _read(places)
    yield from _harmless("names", places)


def _read(places: Mapping[str, Names]) -> Iterator[str]:
    """Yield an item for each set of names that is read, with its places."""
    read: dict[frozenset[str], list[str]] = defaultdict(list)
    for place, names in places.items():
        read[names.read].append(place)
    yield "Read:"
    yield ""
    for words, where in read.items():
        if words:
            yield from _item(", ".join(where), words)


def _harmless(kind: str, places: Mapping[str, Names]) -> Iterator[str]:
    """Yield an item for each reason. A name that is read elsewhere has its place before it."""
    reasons: dict[str, dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
    for place, names in places.items():
        for name, why in names.harmless.items():
            reasons[why][name].append(place.partition(",")[0].strip("`"))
    read = frozenset[str]().union(*(names.read for names in places.values()))
    yield ""
    yield f"Harmless {kind}:"
    yield ""
    for why, where in reasons.items():
        words = [
            f"{at[0]}/{name}" if len(at) == 1 and (name in read or why.startswith(_IDLE)) else name
            for name, at in where.items()
        ]
        yield from _item(why, words)


def _item(head: str, words: Iterable[str]) -> list[str]:
    return _WRAPPER.wrap(f"- {head}: {_code(words)}")


def _code(names: Iterable[str]) -> str:
    """Return names in code font, those of one prefix as `PREFIX_{ONE, OTHER}`."""
    groups: dict[str, list[str]] = defaultdict(list)
    for name in sorted(names, key=lambda name: (name.endswith("="), name)):
        match = _PREFIX.match(name)
        groups[match[0] if match else ""].append(name)
    alone = groups.pop("", [])
    texts = []
    for prefix, group in groups.items():
        if len(group) < _FEWEST:
            alone += group
        else:
            texts.append(f"`{prefix}{{{', '.join(name.removeprefix(prefix) for name in group)}}}`")
    return ", ".join([*texts, *(f"`{name}`" for name in alone)])


def main() -> None:
    for page in PAGES:
        page.write_text(filled(page.read_text("utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
