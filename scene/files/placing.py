"""Expands a graph of placed parts into a list with names. Cycles and huge expansions are errors."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from typing import Generic, TypeVar

from msgspec import Struct

from satcheck.core.transform import Transform, compose
from satcheck.scene.document import (
    COMPONENT_MARK,
    Document,
    Item,
    RawMesh,
    RawPart,
    Refusal,
    UniqueNames,
)
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits

_LONGEST_NAME = 80
_LONGEST_PATH = 200  # characters; of a longer path only the end is kept
_CUT = "..."

Key = TypeVar("Key", bound=Hashable)


class Instance(Struct, Generic[Key], frozen=True):
    """Part `key` at `matrix` (None: identity). path: the names that lead to it, unique."""

    key: Key
    matrix: Transform | None
    path: str


def instances(
    roots: Sequence[tuple[Key, Transform | None]],
    *,
    children: Callable[[Key], Sequence[tuple[Key, Transform | None]]],
    has_mesh: Callable[[Key], bool],
    name: Callable[[Key], str],
    kind: str,
) -> list[Instance[Key]]:
    """Every part under the roots that has a mesh, once for each path that leads to it.

    children: the parts placed inside a part; kind: the noun for a part in messages. Depth first, in
    file order. Raises Refused for a cycle, and for more parts than the limit.
    """
    refuse_explosion(
        [root for root, _ in roots],
        lambda key: [child for child, _ in children(key)],
        lambda key: f"{kind} {name(key)!r}",
    )
    paths = UniqueNames()
    placed = []
    stack = list(_named("", roots, name))[::-1]
    while stack:
        path, key, matrix = stack.pop()
        if has_mesh(key):
            placed.append(Instance(key, matrix, paths.unique(path)))
        below = ((child, multiply(matrix, placement)) for child, placement in children(key))
        stack.extend(list(_named(f"{path}/", below, name))[::-1])
    return placed


def _named(
    prefix: str, placed: Iterable[tuple[Key, Transform | None]], name: Callable[[Key], str]
) -> Iterator[tuple[str, Key, Transform | None]]:
    """Adds a path to each. Siblings with the same name are numbered."""
    names = UniqueNames()
    for key, matrix in placed:
        path = prefix + names.unique(name(key))
        if len(path) > _LONGEST_PATH:
            path = _CUT + path[len(_CUT) - _LONGEST_PATH :]
        yield path, key, matrix


def tidy_name(name: object, otherwise: str) -> str:
    """A name from a file as a step of a path: printable, not too long, and without the mark of
    components; `otherwise` if the result is empty."""
    if not isinstance(name, str):
        return otherwise
    shown = name[:_LONGEST_NAME]
    if not shown.isprintable():
        shown = "".join(c if c.isprintable() else " " for c in shown)
    return shown.replace(COMPONENT_MARK, "").strip() or otherwise


def refuse_explosion(
    roots: Sequence[Key],
    within: Callable[[Key], Iterable[Key]],
    describe: Callable[[Key], str],
) -> None:
    """Counts the elements that references expand to, before any is created.

    Visits each element once. within: the direct children of an element. Raises Refused if an
    element contains itself, or expands to too many elements.
    """
    totals: dict[Key, int] = {}
    open_: set[Key] = set()
    stack = [(root, False) for root in roots]
    while stack:
        key, closing = stack.pop()
        if closing:
            open_.discard(key)
            total = 1 + sum(totals[child] for child in within(key))
            totals[key] = min(total, limits.MAX_PLACEMENTS + 1)  # 2^100 needs no more digits
        elif key in open_:
            raise Refused("reference-cycle", f"{describe(key)} contains itself: a cycle")
        elif key not in totals:
            open_.add(key)
            stack.append((key, True))
            stack.extend((child, False) for child in within(key))
    limits.refuse_many(
        sum(totals[root] for root in roots), "elements that its references expand to"
    )


def raw_scene(
    nodes: Sequence[Instance[Key]],
    name: Callable[[Key], str],
    mesh: Callable[[Key], RawMesh | Refusal],
) -> Document:
    """A scene with each part once, even if many nodes use it."""
    used = {key: place for place, key in enumerate(dict.fromkeys(node.key for node in nodes))}
    names = UniqueNames()
    return Document(
        parts=tuple(RawPart(names.unique(name(key)), mesh(key)) for key in used),
        items=tuple(Item(used[node.key], node.path, node.matrix) for node in nodes),
    )


def multiply(outer: Transform | None, inner: Transform | None) -> Transform | None:
    """The placement of a part at `inner` inside a part at `outer`; both affine."""
    if outer is None or inner is None:
        return inner if outer is None else outer
    return compose(outer, inner)
