"""Writes moved bodies into a scene file. Only the numbers that change are replaced."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.format.entries import SIMPLE
from satcheck.scene.format.placement import matrix, placement
from satcheck.scene.format.positions import Keys, Place
from satcheck.scene.format.problems import Problems
from satcheck.scene.format.table import Table
from satcheck.scene.format.text import Parsed, is_toml, parsed

Edit = tuple[int, int, str]  # (start, end, new text)


def moved(path: str, text: str, placements: Mapping[str, Transform]) -> str:
    """The text of a scene file with new placements for these bodies. The rest is unchanged.

    path: its suffix says whether the text is TOML or JSON. text: a valid scene file of either form.
    placements: id in the file -> world placement. Only its translation may differ from the file.
    Raises ValueError if the rotation or scale differs, or if the id is unknown. Reading the new
    text gives exactly these placements.
    """
    scene = parsed(path, Path(path), text)
    indices = {entry["id"]: index for index, entry in enumerate(scene.document["bodies"])}
    if strange := sorted(placements.keys() - indices.keys()):
        raise ValueError(f"no body {strange[0]!r} in {path}")
    edits = sorted(
        edit for id_, new in placements.items() for edit in _edits(scene, indices[id_], new)
    )
    pieces, done = [], 0
    for start, end, new_text in edits:
        pieces += [text[done:start], new_text]
        done = end
    return "".join([*pieces, text[done:]])


def _edits(scene: Parsed, index: int, new: Transform) -> Iterator[Edit]:
    entry, keys = scene.document["bodies"][index], ("bodies", index)
    is_simple = scene.document["schema"] == SIMPLE
    old = _simple_placement(entry) if is_simple else _placement(entry)
    if any(a != b for k, (a, b) in enumerate(zip(old, new, strict=True)) if k not in (3, 7, 11)):
        raise ValueError(f"body {entry['id']!r} is turned or scaled, not just moved")
    position = (new[3], new[7], new[11])
    key = "transform" if is_simple else "matrix" if "matrix" in entry else "position"
    if entry.get(key) is not None:
        for axis, number in enumerate(position):
            spot: Keys = (*keys, key, axis) if key == "position" else (*keys, key, axis, 3)
            if number != old[4 * axis + 3]:
                place = scene.positions.place(spot)
                yield place.start, place.end, repr(number)
    elif any(position):
        value = _rows(position) if key == "transform" else _list(position)
        yield _addition(scene, keys, key, value)


def _placement(entry: dict[str, Any]) -> Transform:
    return placement(Table(entry, (), Problems())) or IDENTITY


def _simple_placement(entry: dict[str, Any]) -> Transform:
    rows = entry.get("transform")
    return IDENTITY if rows is None else matrix(rows)


def _addition(scene: Parsed, keys: Keys, key: str, value: str) -> Edit:
    """Writes a key that is missing or null after the id of the body."""
    text, toml = scene.text, is_toml(scene.location)
    if key in scene.document["bodies"][keys[1]]:
        place = scene.positions.place((*keys, key))
        return place.start, place.end, value
    body, id_ = scene.positions.place(keys), scene.positions.place((*keys, "id"))
    pair = f"{key} = {value}" if toml else f'"{key}": {value}'
    if toml and body.start == body.end:  # under a header, where each key has its line
        at = _end_of_line(text, id_)
        return at, at, f"{_new_line(text, id_)}{pair}"
    return id_.end, id_.end, f",{_new_line(text, id_) or ' '}{pair}"


def _new_line(text: str, place: Place) -> str:
    """A line break with the indent of the place; empty if it is not at the start of a line."""
    end = text.rfind("\n", 0, place.key)
    before = text[end + 1 : place.key]
    if end < 0 or before.strip():
        return ""
    return ("\r\n" if text.endswith("\r\n", 0, end + 1) else "\n") + before


def _end_of_line(text: str, place: Place) -> int:
    end = text.find("\n", place.end)
    end = len(text) if end < 0 else end
    return end - 1 if text.endswith("\r", 0, end) else end


def _list(numbers: Sequence[float]) -> str:
    return f"[{', '.join(map(repr, numbers))}]"


def _rows(position: Sequence[float]) -> str:
    x, y, z = map(repr, position)
    return f"[[1, 0, 0, {x}], [0, 1, 0, {y}], [0, 0, 1, {z}], [0, 0, 0, 1]]"
